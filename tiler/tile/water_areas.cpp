#include "tiler/tile/water_areas.h"

#include <cmath>

namespace terrane::tiler {

WaterAreas::WaterAreas(const GridFeatures& features) {
  auto line = features.lines.begin();
  for (std::uint32_t body = 0; body < features.shores.size(); ++body) {
    heights_m_.push_back(line->height_m.value_or(0));
    for (std::size_t shore = 0; shore < features.shores[body]; ++shore, ++line) {
      for (std::size_t i = 0; i + 1 < line->points.size(); ++i) {
        const GridPosition &a = line->points[i], &b = line->points[i + 1];
        // a piece lies in one cell; one along a row is crossed by nothing
        if (a.row == b.row) continue;
        sides_[static_cast<std::int64_t>(std::floor((a.row + b.row) / 2))].push_back({a, b, body});
      }
    }
  }
}

std::optional<double> WaterAreas::height_m(const GridPosition& place) const {
  const auto sides = sides_.find(static_cast<std::int64_t>(std::floor(place.row)));
  if (sides == sides_.end()) return std::nullopt;
  std::optional<double> height_m;
  bool is_inside = false;
  std::uint32_t body = 0;
  const auto end_body = [&] {
    if (is_inside) height_m = heights_m_[body];
    is_inside = false;
  };
  for (const auto& [a, b, of] : sides->second) {
    if (of != body) end_body();
    body = of;
    if ((a.row <= place.row) == (b.row <= place.row)) continue;
    const double share = (place.row - a.row) / (b.row - a.row);
    if (place.column < a.column + share * (b.column - a.column)) is_inside = !is_inside;
  }
  end_body();
  return height_m;
}

}  // namespace terrane::tiler

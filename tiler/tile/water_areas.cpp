#include "tiler/tile/water_areas.h"

#include <cmath>

namespace terrane::tiler {

WaterAreas::WaterAreas(const GridFeatures& features) {
  auto line = features.lines.begin();
  for (std::uint32_t body = 0; body < features.shores.size(); ++body) {
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

bool WaterAreas::hold(const GridPosition& place) const {
  const auto sides = sides_.find(static_cast<std::int64_t>(std::floor(place.row)));
  if (sides == sides_.end()) return false;
  bool is_inside = false;
  std::uint32_t body = 0;
  for (const Side& side : sides->second) {
    if (side.body != body) {
      if (is_inside) return true;
      body = side.body;
    }
    const auto& [a, b, of] = side;
    if ((a.row <= place.row) == (b.row <= place.row)) continue;
    const double share = (place.row - a.row) / (b.row - a.row);
    if (place.column < a.column + share * (b.column - a.column)) is_inside = !is_inside;
  }
  return is_inside;
}

}  // namespace terrane::tiler

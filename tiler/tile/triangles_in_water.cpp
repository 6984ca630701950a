#include "tiler/tile/triangles_in_water.h"

#include <algorithm>
#include <set>
#include <utility>

namespace terrane::tiler {

std::vector<std::uint8_t> triangles_in_water(
    const hierarchy::LinedTriangles& full, std::span<const hierarchy::BorderPlace> places,
    std::span<const FeatureLine> lines,
    const std::function<bool(const hierarchy::SampleId&)>& is_water, const WaterAreas& areas) {
  std::set<std::pair<double, double>> on_line;
  for (const FeatureLine& line : lines) {
    for (const GridPosition& p : line.points) on_line.emplace(p.column, p.row);
  }
  const auto is_off_line = [&](std::uint32_t v) {
    return v < full.samples.size() && !on_line.contains({places[v].column, places[v].row});
  };
  std::vector<std::uint8_t> in_water;
  for (const hierarchy::Corners& corners : full.triangles) {
    const auto off_line = std::ranges::find_if(corners, is_off_line);
    if (off_line != corners.end()) {
      in_water.push_back(is_water(full.samples[*off_line]) ? 1 : 0);
      continue;
    }
    GridPosition middle{0, 0};
    for (const std::uint32_t v : corners) {
      middle.column += places[v].column / 3;
      middle.row += places[v].row / 3;
    }
    in_water.push_back(areas.height_m(middle) ? 1 : 0);
  }
  if (std::ranges::count(in_water, 1) == 0) in_water.clear();
  return in_water;
}

}  // namespace terrane::tiler

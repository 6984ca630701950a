#include "tiler/seams/join_tiles.h"

#include <algorithm>
#include <map>

namespace terrane::tiler {

JoinedTiles join(const std::vector<TileMesh>& tiles) {
  JoinedTiles joined;
  std::map<std::pair<double, double>, std::uint32_t> by_place;
  for (const TileMesh& tile : tiles) {
    std::vector<std::uint32_t> number;
    for (std::size_t v = 0; v < tile.points.size(); ++v) {
      const hierarchy::BorderPlace& border = tile.borders[v];
      auto next = static_cast<std::uint32_t>(joined.points.size());
      if (!border.is_none()) {
        next = by_place.emplace(std::pair{border.row, border.column}, next).first->second;
      }
      if (next == joined.points.size()) {
        joined.points.push_back(tile.points[v]);
        joined.borders.push_back(border);
        joined.water_m.push_back(tile.water_m[v]);
      }
      number.push_back(next);
    }
    for (const auto& [a, b, c] : tile.triangles) {
      joined.triangles.push_back({number[a], number[b], number[c]});
    }
    if (!tile.in_water.empty()) {
      joined.in_water.resize(joined.triangles.size() - tile.triangles.size());
      joined.in_water.insert(joined.in_water.end(), tile.in_water.begin(), tile.in_water.end());
    }
    for (const auto& [a, b] : tile.lines) {
      joined.lines.push_back({std::min(number[a], number[b]), std::max(number[a], number[b])});
    }
    joined.number.push_back(std::move(number));
  }
  if (!joined.in_water.empty()) joined.in_water.resize(joined.triangles.size());
  // a line along a border is in both tiles
  std::ranges::sort(joined.lines);
  const auto repeated = std::ranges::unique(joined.lines);
  joined.lines.erase(repeated.begin(), repeated.end());
  return joined;
}

}  // namespace terrane::tiler

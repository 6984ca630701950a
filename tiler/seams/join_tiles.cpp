#include "tiler/seams/join_tiles.h"

#include <map>

namespace terrane::tiler {

JoinedTiles join(const std::vector<TileMesh>& tiles) {
  JoinedTiles joined;
  std::map<std::pair<std::int32_t, std::int32_t>, std::uint32_t> by_sample;
  for (const TileMesh& tile : tiles) {
    std::vector<std::uint32_t> number;
    for (std::size_t v = 0; v < tile.points.size(); ++v) {
      const hierarchy::SampleId sample = tile.samples[v];
      auto next = static_cast<std::uint32_t>(joined.points.size());
      if (sample.column >= 0) {
        next = by_sample.emplace(std::pair{sample.row, sample.column}, next).first->second;
      }
      if (next == joined.points.size()) {
        joined.points.push_back(tile.points[v]);
        joined.samples.push_back(sample);
      }
      number.push_back(next);
    }
    for (const auto& [a, b, c] : tile.triangles) {
      joined.triangles.push_back({number[a], number[b], number[c]});
    }
    joined.number.push_back(std::move(number));
  }
  return joined;
}

}  // namespace terrane::tiler

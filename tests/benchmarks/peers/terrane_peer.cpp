#include <fmt/format.h>

#include "core/progress.h"
#include "peer.h"
#include "tiler/simplify.h"

namespace terrane::peers {

std::vector<Peer> terrane_peers() {
  const auto simplify = [](const Terrain& terrain, double tolerance_m) {
    NoProgress progress;
    const double begin_s = cpu_s();
    const tiler::SimplifiedTerrain result =
        tiler::simplify(terrain.source, {.tolerance_m = tolerance_m}, progress);
    Answer answer{.cpu_s = cpu_s() - begin_s};
    for (const hierarchy::TerrainVertex& v : result.mesh.vertices) {
      answer.mesh.points.push_back(
          {column_of(v.place.plan), row_of(v.place.plan), v.place.height_m});
    }
    answer.mesh.triangles = result.mesh.triangles;
    return std::optional(answer);
  };
  return {{.name = "terrane", .by_tolerance = simplify}};
}

}  // namespace terrane::peers

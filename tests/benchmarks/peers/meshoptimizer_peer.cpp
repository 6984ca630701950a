#include <fmt/format.h>
#include <meshoptimizer.h>

#include "peer.h"

namespace terrane::peers {
namespace {

Answer simplify(const Terrain& terrain, std::size_t triangles, double height_scale,
                unsigned int options) {
  std::vector<std::array<float, 3>> points;
  for (const auto& [column, row, height_m] : terrain.full.points) {
    points.push_back({static_cast<float>(column * terrain.column_m),
                      static_cast<float>(row * terrain.row_m),
                      static_cast<float>(height_m * height_scale)});
  }
  const std::uint32_t* given = terrain.full.triangles.front().data();
  const std::size_t count = terrain.full.triangles.size() * 3;
  const double begin_s = cpu_s();
  Answer answer{.mesh = {.points = terrain.full.points}};
  answer.mesh.triangles.resize(terrain.full.triangles.size());
  constexpr float kAnyError = 1e30F;
  const std::size_t left = meshopt_simplify(
      answer.mesh.triangles.front().data(), given, count, points.front().data(), points.size(),
      sizeof(points.front()), triangles * 3, kAnyError, options, nullptr);
  answer.mesh.triangles.resize(left / 3);
  answer.cpu_s = cpu_s() - begin_s;
  return answer;
}

}  // namespace

// Its error is a distance in space: stretched heights make it look at those more than at the plan.
std::vector<Peer> meshoptimizer_peers() {
  std::vector<Peer> peers;
  for (const unsigned int options : {0U, unsigned{meshopt_SimplifyLockBorder}}) {
    for (const double scale : {0.25, 0.5, 1.0, 2.0, 4.0}) {
      peers.push_back(
          {.name = "meshoptimizer",
           .setting = fmt::format("heights x {}{}", scale, options == 0 ? "" : ", border locked"),
           .by_count = [=](const Terrain& terrain, std::size_t triangles) {
             return simplify(terrain, triangles, scale, options);
           }});
    }
  }
  return peers;
}

}  // namespace terrane::peers

#include "tiler/gltf/tile_skirt.h"

#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace terrane::tiler {
namespace {

using hierarchy::BorderPlace;
using Edge = std::array<std::uint32_t, 2>;

/// Edges with a triangle on one side only, that one to their left, in order; and that triangle.
std::map<Edge, std::size_t> open_edges(const TileMesh& mesh) {
  std::map<Edge, std::size_t> open;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t from = mesh.triangles[t][k], to = mesh.triangles[t][(k + 1) % 3];
      if (open.erase({to, from}) == 0) open.emplace(Edge{from, to}, t);
    }
  }
  return open;
}

/// Do two places on the border lie on one line that the tile shares with a neighbour?
bool is_along_seam(const Pyramid& pyramid, const TileId& tile, const BorderPlace& a,
                   const BorderPlace& b) {
  if (a.is_none() || b.is_none() || (a.column != b.column && a.row != b.row)) return false;
  return pyramid.is_on_seam(tile, a.column, a.row) && pyramid.is_on_seam(tile, b.column, b.row);
}

LatticePoint lowered(const LatticePoint& point, const Eigen::Vector3d& steps) {
  return {point.i + std::llround(steps.x()), point.j + std::llround(steps.y()),
          point.k + std::llround(steps.z())};
}

}  // namespace

TileSkirt hang_skirt(const Pyramid& pyramid, const TileId& tile, const TileMesh& mesh,
                     std::span<const LatticePoint> targets, const Eigen::Vector3d& down_steps) {
  TileSkirt skirt;
  std::map<std::uint32_t, std::uint32_t> upper;  // number in the skirt; the hem's is one more
  const auto number = [&](std::uint32_t v) {
    const auto [at, is_new] = upper.emplace(v, static_cast<std::uint32_t>(skirt.points.size()));
    if (is_new) {
      skirt.above.insert(skirt.above.end(), {v, v});
      skirt.points.insert(skirt.points.end(),
                          {mesh.points[v], lowered(mesh.points[v], down_steps)});
      skirt.targets.insert(skirt.targets.end(), {targets[v], lowered(targets[v], down_steps)});
    }
    return at->second;
  };
  for (const auto& [edge, triangle] : open_edges(mesh)) {
    const auto& [from, to] = edge;
    if (!is_along_seam(pyramid, tile, mesh.borders[from], mesh.borders[to])) continue;
    const std::uint32_t a = number(from), b = number(to);
    skirt.triangles.push_back({a, a + 1, b + 1});
    skirt.triangles.push_back({a, b + 1, b});
    if (!mesh.in_water.empty())
      skirt.in_water.insert(skirt.in_water.end(), 2, mesh.in_water[triangle]);
  }
  return skirt;
}

}  // namespace terrane::tiler

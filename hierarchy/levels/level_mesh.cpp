#include "hierarchy/levels/level_mesh.h"

#include <numeric>
#include <utility>

#include "hierarchy/levels/build_levels.h"

namespace terrane::hierarchy {
namespace {

/// +1 or -1 where all triangles face up or down, else 0.
template <class Point>
double facing(const std::vector<Point>& points, const std::vector<Corners>& triangles) {
  double sign = 0;
  for (const Corners& t : triangles) {
    const Eigen::Vector3d side = (points[t[1]] - points[t[0]]).template cast<double>();
    const Eigen::Vector3d other = (points[t[2]] - points[t[0]]).template cast<double>();
    const double area = side.x() * other.y() - side.y() * other.x();
    if (area == 0) return 0;
    const double own = area > 0 ? 1 : -1;
    if (sign != 0 && own != sign) return 0;
    sign = own;
  }
  return sign;
}

/// Of the vertices of the mesh, those that were split included.
std::vector<Eigen::Vector3i> rounded(const SurfaceMesh& finest, const HalfedgeMesh& mesh,
                                     const PointLattice& lattice) {
  std::vector<Eigen::Vector3i> points;
  points.reserve(mesh.vertex_count());
  for (const Eigen::Vector3d& p : finest.points) {
    points.push_back(lattice.steps(p - lattice.origin()));
  }
  for (auto v = static_cast<std::uint32_t>(points.size()); v < mesh.vertex_count(); ++v) {
    points.push_back(points[mesh.origin(VertexId{v})]);
  }
  return points;
}

}  // namespace

LevelMesh::LevelMesh(const SurfaceMesh& finest)
    : mesh(static_cast<std::uint32_t>(finest.points.size()), finest.triangles),
      lattice(PointLattice::around(finest.points)),
      points(rounded(finest, mesh, lattice)),
      ancestors(points),
      names(mesh.vertex_count()),
      on_border(mesh.vertex_count(), 0) {
  std::iota(names.begin(), names.end(), 0U);
  plan_sign = facing(points, finest.triangles);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    on_border[v] = mesh.is_boundary(VertexId{v});
  }
}

Survivors LevelMesh::compact() {
  Survivors old = mesh.compact();
  old.vertices.resize(mesh.vertex_count());  // nothing is kept of ghosts
  keep_only(points, old.vertices);
  ancestors.compact(old.vertices);
  keep_only(names, old.vertices);
  keep_only(on_border, old.vertices);
  return old;
}

bool is_height_field(const SurfaceMesh& mesh) { return facing(mesh.points, mesh.triangles) != 0; }

}  // namespace terrane::hierarchy

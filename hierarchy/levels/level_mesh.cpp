#include "hierarchy/levels/level_mesh.h"

#include "hierarchy/levels/build_levels.h"

namespace terrane::hierarchy {
namespace {

/// +1 or -1 where all triangles face up or down, else 0.
double facing(const std::vector<Eigen::Vector3d>& points, const std::vector<Corners>& triangles) {
  double sign = 0;
  for (const Corners& t : triangles) {
    const Eigen::Vector3d side = points[t[1]] - points[t[0]], other = points[t[2]] - points[t[0]];
    const double area = side.x() * other.y() - side.y() * other.x();
    if (area == 0) return 0;
    const double own = area > 0 ? 1 : -1;
    if (sign != 0 && own != sign) return 0;
    sign = own;
  }
  return sign;
}

std::vector<Eigen::Vector3d> rounded(const SurfaceMesh& finest, const PointLattice& lattice) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(finest.points.size());
  for (const Eigen::Vector3d& p : finest.points) {
    points.push_back(lattice.round(p - lattice.origin()));
  }
  return points;
}

}  // namespace

LevelMesh::LevelMesh(const SurfaceMesh& finest)
    : mesh(static_cast<std::uint32_t>(finest.points.size()), finest.triangles),
      lattice(PointLattice::around(finest.points)),
      points(rounded(finest, lattice)),
      ancestors(mesh.vertex_count()),
      on_border(mesh.vertex_count(), 0) {
  for (auto v = static_cast<std::uint32_t>(points.size()); v < mesh.vertex_count(); ++v) {
    points.push_back(points[mesh.origin(VertexId{v})]);
  }
  originals = points;
  plan_sign = facing(points, finest.triangles);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    on_border[v] = mesh.is_boundary(VertexId{v});
  }
}

bool is_height_field(const SurfaceMesh& mesh) { return facing(mesh.points, mesh.triangles) != 0; }

}  // namespace terrane::hierarchy

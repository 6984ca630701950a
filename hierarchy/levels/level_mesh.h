#pragma once

#include <vector>

#include "hierarchy/levels/ancestral_points.h"
#include "hierarchy/levels/level_options.h"
#include "hierarchy/levels/point_lattice.h"
#include "hierarchy/levels/surface_mesh.h"
#include "hierarchy/mesh/halfedge_mesh.h"

namespace terrane::hierarchy {

/// The current mesh of a sequence under construction, with what decisions need.
struct LevelMesh {
  explicit LevelMesh(const SurfaceMesh& finest);

  /// Lets go of what is dead, see HalfedgeMesh::compact().
  Survivors compact();

  Eigen::Vector3d point(VertexId v) const { return lattice.relative(points[index(v)]); }
  /// Twice the area of a triangle in plan, positive if it faces the way all do; exact.
  double plan_area(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                   const Eigen::Vector3d& c) const {
    return plan_sign * ((b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x()));
  }

  HalfedgeMesh mesh;
  PointLattice lattice;
  std::vector<Eigen::Vector3i> points;  ///< of live vertices, in lattice steps
  AncestralPoints ancestors;
  std::vector<std::uint32_t> names;     ///< the number that a vertex had in M_0; they ascend
  std::vector<std::uint8_t> on_border;  ///< is the vertex on a boundary loop?
  double plan_sign = 0;                 ///< +1 or -1 for a height field, seen from above or below
};

}  // namespace terrane::hierarchy

#pragma once

#include <Eigen/Core>
#include <vector>

#include "hierarchy/mesh/halfedge_mesh.h"

namespace terrane::hierarchy {

/// Any triangle mesh: open or closed, a height field or not.
struct SurfaceMesh {
  std::vector<Eigen::Vector3d> points;  ///< in the unit of the mesh (metres for a DEM)
  std::vector<Corners> triangles;       ///< indices into points, counter-clockwise from outside
};

}  // namespace terrane::hierarchy

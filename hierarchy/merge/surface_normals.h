#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "hierarchy/mesh/halfedge_mesh.h"

namespace terrane::hierarchy {

/// Unit normals of the vertices: of the sum of their triangles' area vectors; (0, 0, 1) for a
/// vertex without area.
std::vector<Eigen::Vector3d> vertex_normals(std::span<const Eigen::Vector3d> points,
                                            std::span<const Corners> triangles);

}  // namespace terrane::hierarchy

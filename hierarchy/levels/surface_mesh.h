#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "hierarchy/mesh/halfedge_mesh.h"

namespace terrane::hierarchy {

/// Red, green and blue of a vertex, 0 to 255.
using Colour = std::array<std::uint8_t, 3>;

/// Any triangle mesh: open or closed, a height field or not.
struct SurfaceMesh {
  std::vector<Eigen::Vector3d> points;  ///< in the unit of the mesh (metres for a DEM)
  std::vector<Corners> triangles;       ///< indices into points, counter-clockwise from outside
  std::vector<Colour> colours;          ///< of the points, or empty
};

}  // namespace terrane::hierarchy

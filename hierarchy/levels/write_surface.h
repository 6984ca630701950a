#pragma once

#include <Eigen/Core>
#include <span>
#include <string>

#include "hierarchy/levels/surface_mesh.h"

namespace terrane::hierarchy {

/// The mesh as a binary PLY (little-endian): x, y, z as doubles, exact to the last bit;
/// red, green, blue as bytes, if it has colours.
///
/// \param targets  where each vertex morphs to, as the further properties target_x, target_y,
///                 target_z; one for each point, or empty.
std::string encode_ply(const SurfaceMesh& mesh, std::span<const Eigen::Vector3d> targets = {});

/// The mesh as an OBJ: coordinates with as many digits as they need to be read back exactly.
std::string encode_obj(const SurfaceMesh& mesh);

}  // namespace terrane::hierarchy

#pragma once

#include <Eigen/Core>
#include <vector>

#include "tiler/verify/terrain_examination.h"
#include "tiler/verify/terrain_file.h"

namespace terrane::verify {

// What tiles of any format claim.

/// Indices of triangles and border lists. Nothing else can be judged where one is found wrong.
std::vector<FaultFound> examine_indices(const TerrainFile& tile);

/// Bounding sphere, horizon occlusion point and normals.
/// \param ecef  the places of the vertices.
std::vector<FaultFound> examine_claims(const TerrainFile& tile,
                                       const std::vector<Eigen::Vector3d>& ecef);

}  // namespace terrane::verify

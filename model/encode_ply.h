#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace terrane::model {

/// Triangles as a binary PLY (little endian, double coordinates): corners at the very same place
/// become one vertex, triangles without area are left out.
///
/// \param materials  a number for each triangle, written as the face property "material"; empty:
///                   none.
std::string encode_ply(const std::vector<std::array<Eigen::Vector3d, 3>>& triangles,
                       const std::vector<std::uint8_t>& materials = {});

}  // namespace terrane::model

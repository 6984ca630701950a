#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace terrane::tiler {

/// The bytes of a binary glTF with one mesh and one morph target.
///
/// Plain glTF 2.0 without extensions: positions as floats from the middle of the mesh, which is the
/// node's translation; y up as glTF wants it (x, z, -y of the input).
/// \param points     in metres, or the unit of the mesh; at least one.
/// \param targets    where each point is at weight 1; as many, or none for a mesh without morph.
/// \param triangles  indices into points, counter-clockwise from outside.
std::string encode_morphing_glb(std::span<const Eigen::Vector3d> points,
                                std::span<const Eigen::Vector3d> targets,
                                std::span<const std::array<std::uint32_t, 3>> triangles);

}  // namespace terrane::tiler

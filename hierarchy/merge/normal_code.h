#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace terrane::hierarchy {

/// The nearest normal that a tree's file holds: octahedral coordinates of 16 bits each.
std::uint32_t encoded_normal(const Eigen::Vector3d& unit);

/// The unit normal of a code; any 32 bits are one.
Eigen::Vector3f decoded_normal(std::uint32_t code);

}  // namespace terrane::hierarchy

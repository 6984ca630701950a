#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace terrane::hierarchy::volume {

/// A point where the edge of one triangle passes through the inside or the border of the other, if
/// there is one. Triangles in one plane do not cross.
std::optional<Eigen::Vector3d> crossing(const std::array<Eigen::Vector3d, 3>& a,
                                        const std::array<Eigen::Vector3d, 3>& b);

}  // namespace terrane::hierarchy::volume

#pragma once

#include <Eigen/Core>
#include <array>

namespace terrane::hierarchy::volume {

/// The point of a triangle that is nearest to another point, and where in the triangle it lies.
struct ClosestPoint {
  Eigen::Vector3d point;
  double squared_distance = 0;
  /// 0 1 2: at that corner; 3 4 5: on the edge from corner 0, 1, 2 to the next; 6: inside.
  int feature = 6;
};

/// \param corners  in any order; a triangle without area counts as its edges.
/// \par Source
/// Ericson, Real-Time Collision Detection (2005), section 5.1.5.
ClosestPoint closest_point(const Eigen::Vector3d& p, const std::array<Eigen::Vector3d, 3>& corners);

}  // namespace terrane::hierarchy::volume

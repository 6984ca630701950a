#pragma once

#include <Eigen/Core>

namespace terrane::hierarchy {

/// m_v of the valence term: the penalty is 1 for a new vertex with twelve edges more than the best.
inline constexpr double kLargestValenceExcess = 12;

/// Area of a triangle and its shape: alpha = 2 ((sum of the cosines of its angles) - 1), from 0 for
/// a degenerate to 1 for an equilateral one.
struct TriangleShape {
  double area = 0;
  double angle = 0;
};
TriangleShape shape_of(const Eigen::Vector3d& p1, const Eigen::Vector3d& p2,
                       const Eigen::Vector3d& p3);

/// V(T) = |val(c) - 6| / m_v of the vertex that a collapse makes.
double valence_term(int new_valence);

}  // namespace terrane::hierarchy

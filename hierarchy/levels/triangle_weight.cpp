#include "hierarchy/levels/triangle_weight.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdlib>

namespace terrane::hierarchy {

TriangleShape shape_of(const Eigen::Vector3d& p1, const Eigen::Vector3d& p2,
                       const Eigen::Vector3d& p3) {
  const Eigen::Vector3d a = p2 - p1, b = p3 - p2, c = p1 - p3;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  if (!(la > 0 && lb > 0 && lc > 0)) return {};
  const double cosines = -a.dot(c) / (la * lc) - b.dot(a) / (lb * la) - c.dot(b) / (lc * lb);
  return {a.cross(b).norm() / 2, 2 * (cosines - 1)};
}

double valence_term(int new_valence) { return std::abs(new_valence - 6) / kLargestValenceExcess; }

}  // namespace terrane::hierarchy

#include "hierarchy/volume/closest_point.h"

namespace terrane::hierarchy::volume {
namespace {

ClosestPoint found(const Eigen::Vector3d& p, const Eigen::Vector3d& at, int feature) {
  return {at, (p - at).squaredNorm(), feature};
}

}  // namespace

ClosestPoint closest_point(const Eigen::Vector3d& p,
                           const std::array<Eigen::Vector3d, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return found(p, a, 0);

  const Eigen::Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return found(p, b, 1);

  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return found(p, a + ab * (d1 / (d1 - d3)), 3);

  const Eigen::Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return found(p, c, 2);

  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return found(p, a + ac * (d2 / (d2 - d6)), 5);

  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    return found(p, b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))), 4);
  }
  const double scale = 1 / (va + vb + vc);
  return found(p, a + ab * (vb * scale) + ac * (vc * scale), 6);
}

}  // namespace terrane::hierarchy::volume

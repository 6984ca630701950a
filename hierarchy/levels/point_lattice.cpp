#include "hierarchy/levels/point_lattice.h"

#include <algorithm>
#include <cmath>

namespace terrane::hierarchy {
namespace {

// two bits less than exactness allows: collapse points may lie outside the box of M_0
constexpr int kBits = 22;

}  // namespace

PointLattice::PointLattice(const Eigen::Vector3d& origin, int exponent)
    : origin_(origin), exponent_(exponent), step_(std::ldexp(1.0, exponent)) {}

PointLattice PointLattice::around(std::span<const Eigen::Vector3d> points) {
  Eigen::Vector3d low = points.front(), high = low;
  for (const Eigen::Vector3d& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  int exponent = 0;
  // extent < 2^exponent; a single point counts as of size 1
  std::frexp(std::max((high - low).maxCoeff(), std::numeric_limits<double>::min()), &exponent);
  return {low, std::max(exponent, -900) - kBits};
}

Eigen::Vector3d PointLattice::round(const Eigen::Vector3d& relative) const {
  // half-way cases go up on every axis, whatever the sign
  return ((relative / step_).array() + 0.5).floor().matrix() * step_;
}

Eigen::Vector3i PointLattice::steps(const Eigen::Vector3d& relative) const {
  return ((relative / step_).array() + 0.5).floor().matrix().cast<int>();
}

}  // namespace terrane::hierarchy

#pragma once

#include <Eigen/Core>
#include <span>

namespace terrane::hierarchy {

/// The grid of places on which every vertex of a hierarchy lies: origin + step * (i, j, k).
///
/// The step is a power of two and no mesh spans more than 2^24 of them, so places are exact as
/// doubles, differences and orientation tests in plan are, too, and a file holds them as integers.
class PointLattice {
 public:
  PointLattice() = default;
  PointLattice(const Eigen::Vector3d& origin, int exponent);
  /// The finest lattice on which the bounding box of \p points spans 2^22 steps at most.
  /// \pre all coordinates are finite, and there is a point.
  static PointLattice around(std::span<const Eigen::Vector3d> points);

  const Eigen::Vector3d& origin() const { return origin_; }
  int exponent() const { return exponent_; }  ///< step = 2^exponent
  double step() const { return step_; }

  /// The nearest place, relative to the origin.
  Eigen::Vector3d round(const Eigen::Vector3d& relative) const;
  Eigen::Vector3i steps(const Eigen::Vector3d& relative) const;
  Eigen::Vector3d relative(const Eigen::Vector3i& steps) const {
    return steps.cast<double>() * step_;
  }

 private:
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  int exponent_ = 0;
  double step_ = 1;
};

}  // namespace terrane::hierarchy

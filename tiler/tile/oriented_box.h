#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

namespace terrane::tiler {

/// Three unit vectors at right angles, right-handed, one per column.
using Axes = Eigen::Matrix3d;

/// A box along axes of its own.
///
/// Plain values, kept in work files.
struct OrientedBox {
  Axes axes = Axes::Identity();
  Eigen::Vector3d low = Eigen::Vector3d::Constant(INFINITY);  ///< along the axes
  Eigen::Vector3d high = Eigen::Vector3d::Constant(-INFINITY);

  void add(const Eigen::Vector3d& point);
  void add(const OrientedBox& box);

  Eigen::Vector3d centre() const { return axes * ((low + high) / 2); }
  double diagonal_m() const { return (high - low).norm(); }
  /// Centre and half axes, as boundingVolume.box has them.
  std::array<double, 12> numbers() const;
};

}  // namespace terrane::tiler

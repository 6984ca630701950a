#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "tiler/tile/world_frame.h"

namespace terrane::tiler {

/// Lines that pass so near beside a triangle meet it, as a share of it.
inline constexpr double kOnEdge = 1e-7;

/// A triangle in the world, met by plumb lines as by rays (Moeller and Trumbore 1997).
class PlumbTriangle {
 public:
  PlumbTriangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
      : corner_(a), side_b_(b - a), side_c_(c - a) {}

  /// Height along the plumb line at which the triangle is met; none if it is not.
  /// \param beside  where lines that pass beside the triangle count, as a share of it.
  std::optional<double> height_m(const Plumb& plumb, double beside = kOnEdge) const {
    const Eigen::Vector3d p = plumb.up.cross(side_c_);
    const Eigen::Vector3d s = plumb.base - corner_;
    const Eigen::Vector3d q = s.cross(side_b_);
    const double scale = 1 / side_b_.dot(p);
    const double u = s.dot(p) * scale, v = plumb.up.dot(q) * scale;
    if (u < -beside || v < -beside || u + v > 1 + beside) return std::nullopt;
    return side_c_.dot(q) * scale;
  }

  const Eigen::Vector3d& corner() const { return corner_; }
  Eigen::Vector3d normal() const { return side_b_.cross(side_c_); }

  /// How much it rises over a metre across the plumb line.
  double rise(const Eigen::Vector3d& up) const {
    const Eigen::Vector3d n = normal();
    const double upright = n.dot(up);
    return (n - upright * up).norm() / std::abs(upright);
  }
  /// Smallest altitude seen along the plumb line.
  double altitude_m(const Eigen::Vector3d& up) const {
    const double longest2 =
        std::max({side_b_.cross(up).squaredNorm(), side_c_.cross(up).squaredNorm(),
                  (side_c_ - side_b_).cross(up).squaredNorm()});
    return std::abs(normal().dot(up)) / std::sqrt(longest2);
  }

 private:
  Eigen::Vector3d corner_, side_b_, side_c_;
};

}  // namespace terrane::tiler

#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace terrane::hierarchy::volume {

using TetraCorners = std::array<Eigen::Vector3d, 4>;

/// Places in a tetrahedron as weights of its corners (which add up to 1).
class Barycentric {
 public:
  /// \pre the tetrahedron has a volume.
  explicit Barycentric(const TetraCorners& corners);

  /// Weights of a place; one is below 0 where the place lies outside.
  Eigen::Vector4d weights(const Eigen::Vector3d& p) const {
    Eigen::Vector4d w;
    w.tail<3>() = inverse_ * (p - origin_);
    w[0] = 1 - w[1] - w[2] - w[3];
    return w;
  }
  /// Direction and strength in which the weight of a corner grows.
  Eigen::Vector3d gradient(int corner) const;
  double volume() const { return volume_; }

 private:
  Eigen::Vector3d origin_;
  Eigen::Matrix3d inverse_;
  double volume_ = 0;
};

/// A convex polygon of few corners, in order.
struct SmallPolygon {
  std::array<Eigen::Vector3d, 7> points;
  int size = 0;
};

/// The part of a triangle that lies in a tetrahedron; empty (size 0) where they do not meet.
///
/// Touching counts: what lies outside by less than 10^-9 of an altitude is kept, so that a triangle
/// in the face between two cells is lost to neither.
SmallPolygon clip(const std::array<Eigen::Vector3d, 3>& triangle, const Barycentric& cell);

/// Where a function that is linear in a tetrahedron is zero: nothing, a point, an edge, a triangle
/// or a quadrangle.
struct ZeroSet {
  std::array<Eigen::Vector3d, 4> points;
  int size = 0;

  bool is_empty() const { return size == 0; }
  /// \pre !is_empty().
  double distance(const Eigen::Vector3d& p) const;
};

/// \param values  of the function at the corners.
ZeroSet zero_set(const TetraCorners& corners, const std::array<double, 4>& values);

/// Tetrahedron inside a cell: each column holds the weights of one corner.
using SubTetra = Eigen::Matrix4d;

/// Cuts tetrahedra in two along the zero set of a linear function.
///
/// \param values  of the function at the corners of the cell.
/// \param below, above  get the parts where it is below 0, and where it is not.
void cut(const SubTetra& tetra, const Eigen::Vector4d& values, std::vector<SubTetra>& below,
         std::vector<SubTetra>& above);

}  // namespace terrane::hierarchy::volume

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <span>
#include <vector>

namespace terrane::hierarchy {

/// Orthonormal frame in the plane of a triangle: origin in its centroid c, n its unit normal.
class TriangleFrame {
 public:
  /// \return nothing if the triangle has no area, and so no plane.
  static std::optional<TriangleFrame> of(const Eigen::Vector3d& p1, const Eigen::Vector3d& p2,
                                         const Eigen::Vector3d& p3);

  /// (u, v) in the plane and the distance d from it.
  Eigen::Vector3d to_local(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d q = p - c_;
    return {q.dot(u_), q.dot(v_), q.dot(n_)};
  }
  Eigen::Vector3d to_world(const Eigen::Vector3d& uvd) const {
    return c_ + uvd.x() * u_ + uvd.y() * v_ + uvd.z() * n_;
  }
  const Eigen::Vector3d& normal() const { return n_; }
  const Eigen::Vector3d& centroid() const { return c_; }
  /// A world direction, in the frame.
  Eigen::Vector3d direction(const Eigen::Vector3d& w) const {
    return {w.dot(u_), w.dot(v_), w.dot(n_)};
  }

 private:
  Eigen::Vector3d c_, u_, v_, n_;
};

/// Quadratic height function f(u, v) over the plane of one triangle.
///
/// \par Source
/// Gieng et al. 1998, section 4: eqs. (1) to (3) for f, (4) to (7) for the curvatures, (8) for the
/// image of an edge, whose misprints are mended (docs/papers.md).
class LocalSurface {
 public:
  LocalSurface() = default;
  /// f = c20 u^2 + c11 u v + c02 v^2 + c10 u + c01 v + c00.
  LocalSurface(double c20, double c11, double c02, double c10, double c01, double c00)
      : c20_(c20), c11_(c11), c02_(c02), c10_(c10), c01_(c01), c00_(c00) {}

  double at(double u, double v) const {
    return (c20_ * u + c11_ * v + c10_) * u + (c02_ * v + c01_) * v + c00_;
  }

  /// |k1| + |k2| of the graph of f at the centroid (0, 0), in 1/unit; never negative.
  double absolute_curvature() const;

  /// Largest distance along n between f and the straight edge a-b.
  ///
  /// The edge need not lie in the plane of the triangle: its own height is subtracted.
  /// \param a, b  (u, v, d) in the triangle's frame.
  double edge_error(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;

  /// How far a point has to go along a direction to reach the graph of f, the nearer way of two.
  ///
  /// \param from, direction  (u, v, d) in the triangle's frame.
  /// \return the multiple of \p direction; 0 if the line misses the graph.
  double distance_along(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const;

 private:
  double c20_ = 0, c11_ = 0, c02_ = 0, c10_ = 0, c01_ = 0, c00_ = 0;
};

/// Fits surfaces by least squares; keeps the scratch space, so that a fit does not allocate.
class SurfaceFitter {
 public:
  void clear() { rows_.clear(); }
  std::size_t size() const { return rows_.size(); }
  /// Adds a point (u, v, d) of a triangle's frame.
  void add(const Eigen::Vector3d& uvd) { rows_.push_back({uvd.x(), uvd.y(), uvd.z()}); }

  /// The least-squares surface over the points added, by Householder QR.
  ///
  /// \return nothing if there are fewer than six points, or they do not determine f (all on one
  ///         conic): the caller widens the stencil, as the paper's footnote 3 says.
  std::optional<LocalSurface> fit();

 private:
  struct Row {
    double u, v, d;
  };
  std::vector<Row> rows_;
  // u^2, uv, v^2, u, v, 1, d, and one more to make rows of whole vector registers
  std::vector<std::array<double, 8>> system_;
};

}  // namespace terrane::hierarchy

#include "hierarchy/levels/local_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace terrane::hierarchy {

std::optional<TriangleFrame> TriangleFrame::of(const Eigen::Vector3d& p1, const Eigen::Vector3d& p2,
                                               const Eigen::Vector3d& p3) {
  const Eigen::Vector3d side = p2 - p1;
  const Eigen::Vector3d normal = side.cross(p3 - p1);
  const double twice_area = normal.norm(), length = side.norm();
  if (!(twice_area > 0)) return std::nullopt;
  TriangleFrame frame;
  frame.c_ = (p1 + p2 + p3) / 3;
  frame.n_ = normal / twice_area;
  frame.u_ = side / length;
  frame.v_ = frame.n_.cross(frame.u_);
  return frame;
}

double LocalSurface::absolute_curvature() const {
  const double fu = c10_, fv = c01_, fuu = 2 * c20_, fuv = c11_, fvv = 2 * c02_;
  const double g = 1 + fu * fu + fv * fv;
  const double gaussian = (fuu * fvv - fuv * fuv) / (g * g);
  const double mean =
      ((1 + fu * fu) * fvv - 2 * fu * fv * fuv + (1 + fv * fv) * fuu) / (2 * g * std::sqrt(g));
  // |k1| + |k2| = 2 |H| if both have one sign, else k1 - k2
  if (gaussian >= 0) return 2 * std::abs(mean);
  return 2 * std::sqrt(mean * mean - gaussian);
}

double LocalSurface::edge_error(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
  const double u0 = a.x(), v0 = a.y(), a0 = b.x() - u0, b0 = b.y() - v0;
  const double A = c20_ * a0 * a0 + c11_ * a0 * b0 + c02_ * b0 * b0;
  const double B = 2 * c20_ * u0 * a0 + c11_ * (u0 * b0 + v0 * a0) + 2 * c02_ * v0 * b0 +
                   c10_ * a0 + c01_ * b0 - (b.z() - a.z());
  const double C = at(u0, v0) - a.z();
  double largest = std::max(std::abs(C), std::abs(A + B + C));
  const double t = -B / (2 * A);
  // false for A = 0: a straight image has no inner extremum
  if (t > 0 && t < 1) largest = std::max(largest, std::abs(C + t * B / 2));
  return largest;
}

double LocalSurface::distance_along(const Eigen::Vector3d& from,
                                    const Eigen::Vector3d& direction) const {
  const double u = from.x(), v = from.y(), du = direction.x(), dv = direction.y();
  // f - d along the line = A s^2 + B s + C
  const double A = c20_ * du * du + c11_ * du * dv + c02_ * dv * dv;
  const double B = 2 * c20_ * u * du + c11_ * (u * dv + v * du) + 2 * c02_ * v * dv + c10_ * du +
                   c01_ * dv - direction.z();
  const double C = at(u, v) - from.z();
  const double discriminant = B * B - 4 * A * C;
  if (discriminant < 0 || B == 0) return 0;
  // the smaller root, without a difference of like numbers
  return -2 * C / (B + std::copysign(std::sqrt(discriminant), B));
}

namespace {

constexpr std::size_t kTerms = 6;
/// Pivots below this share of the largest one: the points lie on a conic, or so near to one that f
/// is anything beside them. (Points of a grid often lie on two lines, which are a conic: turned
/// into a triangle's plane no longer exactly, and f(0, 0) was once 271 m off points that it met
/// within 1.)
constexpr double kSmallestPivot = 1e-2;

using SystemRow = std::array<double, 8>;

/// Reflects column k onto its diagonal; the columns to the right follow. Rows are walked in memory
/// order and all columns at once, in pairs as registers hold them, which is what makes it fast.
template <std::size_t k>
double reflect(std::span<SystemRow> rows) {
  constexpr std::size_t kFirst = k / 2 * 2;
  double norm2 = 0;
  for (std::size_t i = k; i < rows.size(); ++i) norm2 += rows[i][k] * rows[i][k];
  const double norm = std::sqrt(norm2);
  if (norm == 0) return 0;
  const double pivot = rows[k][k] > 0 ? -norm : norm;
  const double first = rows[k][k] - pivot;  // v = column - pivot e_k, and v . v = -2 pivot first
  const double scale = 1 / (pivot * first);
  rows[k][k] = first;

  SystemRow sum{};
  for (std::size_t i = k; i < rows.size(); ++i) {
    const double v = rows[i][k];
    for (std::size_t j = kFirst; j < 8; ++j) sum[j] += v * rows[i][j];
  }
  for (double& s : sum) s *= scale;
  for (std::size_t i = k; i < rows.size(); ++i) {
    const double v = rows[i][k];
    for (std::size_t j = kFirst; j < 8; ++j) rows[i][j] += v * sum[j];
  }
  rows[k][k] = pivot;
  return norm;
}

/// The norms that the six columns have when their turn comes.
template <std::size_t... k>
std::array<double, kTerms> reflect_all(std::span<SystemRow> rows, std::index_sequence<k...>) {
  return {reflect<k>(rows)...};  // in braces: from left to right
}

}  // namespace

std::optional<LocalSurface> SurfaceFitter::fit() {
  if (rows_.size() < kTerms) return std::nullopt;
  double radius2 = 0;
  for (const Row& row : rows_) radius2 = std::max(radius2, row.u * row.u + row.v * row.v);
  if (!(radius2 > 0)) return std::nullopt;
  // unit of length = the radius: no term is much larger than another
  const double unit = 1 / std::sqrt(radius2);
  system_.clear();
  for (const Row& row : rows_) {
    const double u = row.u * unit, v = row.v * unit;
    system_.push_back({u * u, u * v, v * v, u, v, 1, row.d, 0});
  }

  const auto pivots = reflect_all(system_, std::make_index_sequence<kTerms>());
  const auto [smallest, largest] = std::ranges::minmax(pivots);
  if (smallest <= kSmallestPivot * largest) return std::nullopt;

  std::array<double, kTerms> x{};
  for (std::size_t k = kTerms; k-- > 0;) {
    double rest = system_[k][6];
    for (std::size_t j = k + 1; j < kTerms; ++j) rest -= system_[k][j] * x[j];
    x[k] = rest / system_[k][k];
  }
  const double unit2 = unit * unit;
  return LocalSurface(x[0] * unit2, x[1] * unit2, x[2] * unit2, x[3] * unit, x[4] * unit, x[5]);
}

}  // namespace terrane::hierarchy

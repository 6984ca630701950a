#include "hierarchy/volume/tetra_geometry.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "hierarchy/volume/closest_point.h"

namespace terrane::hierarchy::volume {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr double kTouch = 1e-9;  // of an altitude

struct Weighted {
  Vector3d point;
  Vector4d weights;
};

double squared_distance_to_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d ab = b - a;
  const double length = ab.squaredNorm();
  const double t = length > 0 ? std::clamp((p - a).dot(ab) / length, 0.0, 1.0) : 0.0;
  return (p - a - t * ab).squaredNorm();
}

// Three tetrahedra that fill a prism with the triangles a and b.
void fill_prism(const std::array<Vector4d, 3>& a, const std::array<Vector4d, 3>& b,
                std::vector<SubTetra>& out) {
  const auto add = [&](const Vector4d& p, const Vector4d& q, const Vector4d& r, const Vector4d& s) {
    SubTetra tetra;
    tetra << p, q, r, s;
    out.push_back(tetra);
  };
  add(a[0], a[1], a[2], b[0]);
  add(a[1], a[2], b[0], b[1]);
  add(a[2], b[0], b[1], b[2]);
}

// One corner on one side, three on the other.
void cut_corner(const std::array<Vector4d, 4>& corner, const Vector4d& f,
                std::vector<SubTetra>& tip_side, std::vector<SubTetra>& rest_side) {
  std::array<Vector4d, 3> cuts;
  for (int k = 0; k < 3; ++k) {
    const double t = f[0] / (f[0] - f[k + 1]);
    cuts[k] = corner[0] + t * (corner[k + 1] - corner[0]);
  }
  SubTetra tip;
  tip << corner[0], cuts[0], cuts[1], cuts[2];
  tip_side.push_back(tip);
  fill_prism(cuts, {corner[1], corner[2], corner[3]}, rest_side);
}

// Corners 0 and 1 on one side, 2 and 3 on the other.
void cut_edge(const std::array<Vector4d, 4>& corner, const Vector4d& f,
              std::vector<SubTetra>& first_side, std::vector<SubTetra>& second_side) {
  const auto between = [&](int a, int b) -> Vector4d {
    return corner[a] + f[a] / (f[a] - f[b]) * (corner[b] - corner[a]);
  };
  const Vector4d c02 = between(0, 2), c03 = between(0, 3), c12 = between(1, 2), c13 = between(1, 3);
  fill_prism({corner[0], c02, c03}, {corner[1], c12, c13}, first_side);
  fill_prism({corner[2], c02, c12}, {corner[3], c03, c13}, second_side);
}

}  // namespace

Barycentric::Barycentric(const TetraCorners& corners) : origin_(corners[0]) {
  Eigen::Matrix3d edges;
  for (int i = 0; i < 3; ++i) edges.col(i) = corners[i + 1] - corners[0];
  volume_ = std::abs(edges.determinant()) / 6;
  inverse_ = edges.inverse();
}

Vector3d Barycentric::gradient(int corner) const {
  if (corner > 0) return inverse_.row(corner - 1).transpose();
  return -inverse_.colwise().sum().transpose();
}

SmallPolygon clip(const std::array<Vector3d, 3>& triangle, const Barycentric& cell) {
  std::array<Weighted, 8> polygon, next;
  int size = 3;
  Vector4d largest = Vector4d::Constant(-1e300), smallest = -largest;
  for (int k = 0; k < 3; ++k) {
    polygon[k] = {triangle[k], cell.weights(triangle[k])};
    largest = largest.cwiseMax(polygon[k].weights);
    smallest = smallest.cwiseMin(polygon[k].weights);
  }
  if (largest.minCoeff() < -kTouch) return {};  // wholly outside one face
  if (smallest.minCoeff() >= -kTouch) return {{triangle[0], triangle[1], triangle[2]}, 3};
  for (int corner = 0; corner < 4 && size > 0; ++corner) {
    int kept = 0;
    for (int k = 0; k < size; ++k) {
      const Weighted &a = polygon[k], &b = polygon[(k + 1) % size];
      const double u = a.weights[corner] + kTouch, v = b.weights[corner] + kTouch;
      if (u >= 0) next[kept++] = a;
      if ((u < 0) == (v < 0)) continue;
      const double t = u / (u - v);
      next[kept++] = {a.point + t * (b.point - a.point), a.weights + t * (b.weights - a.weights)};
    }
    // rounding can give a corner twice on a plane that a triangle only touches
    size = std::min(kept, 7);
    std::copy_n(next.begin(), size, polygon.begin());
  }
  SmallPolygon result;
  result.size = size;
  for (int k = 0; k < size; ++k) result.points[k] = polygon[k].point;
  return result;
}

ZeroSet zero_set(const TetraCorners& corners, const std::array<double, 4>& values) {
  std::array<int, 4> below, above;
  int below_count = 0, above_count = 0;
  ZeroSet zero;
  for (int k = 0; k < 4; ++k) {
    if (values[k] < 0) {
      below[below_count++] = k;
    } else if (values[k] > 0) {
      above[above_count++] = k;
    } else {
      zero.points[zero.size++] = corners[k];
    }
  }
  for (int i = 0; i < below_count; ++i) {
    for (int j = 0; j < above_count; ++j) {
      const int a = below[i];
      const int b = above[i == 0 ? j : above_count - 1 - j];  // so that four points go around
      const double t = values[a] / (values[a] - values[b]);
      zero.points[zero.size++] = corners[a] + t * (corners[b] - corners[a]);
    }
  }
  return zero;
}

double ZeroSet::distance(const Vector3d& p) const {
  switch (size) {
    case 1:
      return (p - points[0]).norm();
    case 2:
      return std::sqrt(squared_distance_to_segment(p, points[0], points[1]));
    case 3:
      return std::sqrt(closest_point(p, {points[0], points[1], points[2]}).squared_distance);
    default:
      return std::sqrt(
          std::min(closest_point(p, {points[0], points[1], points[2]}).squared_distance,
                   closest_point(p, {points[0], points[2], points[3]}).squared_distance));
  }
}

void cut(const SubTetra& tetra, const Vector4d& values, std::vector<SubTetra>& below,
         std::vector<SubTetra>& above) {
  const Vector4d f = tetra.transpose() * values;
  std::array<int, 4> order = {0, 1, 2, 3};
  std::ranges::stable_sort(order, [&](int a, int b) { return (f[a] < 0) > (f[b] < 0); });
  const auto below_count = std::ranges::count_if(order, [&](int k) { return f[k] < 0; });
  if (below_count == 0) return above.push_back(tetra);
  if (below_count == 4) return below.push_back(tetra);
  if (below_count == 3) std::ranges::reverse(order);  // the single one first
  std::array<Vector4d, 4> corner;
  Vector4d g;
  for (int k = 0; k < 4; ++k) {
    corner[k] = tetra.col(order[k]);
    g[k] = f[order[k]];
  }
  if (below_count == 2) return cut_edge(corner, g, below, above);
  if (below_count == 1) return cut_corner(corner, g, below, above);
  cut_corner(corner, g, above, below);
}

}  // namespace terrane::hierarchy::volume

#include "hierarchy/volume/grid_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"

namespace terrane::hierarchy::volume {
namespace {

using Eigen::Vector3d;

// A box around a tetrahedron is six times as large: halving it and leaving out what the
// tetrahedron does not touch tightens the bound.
constexpr int kHalvings = 2;

Vector3d low_corner(const TetraCorners& c) {
  return c[0].cwiseMin(c[1]).cwiseMin(c[2]).cwiseMin(c[3]);
}
Vector3d high_corner(const TetraCorners& c) {
  return c[0].cwiseMax(c[1]).cwiseMax(c[2]).cwiseMax(c[3]);
}

/// False only where a box lies wholly outside one face of a cell.
bool may_touch(const Barycentric& cell, const Vector3d& low, const Vector3d& high) {
  const Eigen::Vector4d centre = cell.weights((low + high) / 2);
  const Vector3d half = (high - low) / 2;
  for (int k = 0; k < 4; ++k) {
    if (centre[k] + cell.gradient(k).cwiseAbs().dot(half) < 0) return false;
  }
  return true;
}

Vector3d corner_of(int k, const Vector3d& low, const Vector3d& high) {
  return {(k & 1) != 0 ? high.x() : low.x(), (k & 2) != 0 ? high.y() : low.y(),
          (k & 4) != 0 ? high.z() : low.z()};
}

}  // namespace

GridField::GridField(std::array<std::vector<double>, 3> axes,
                     std::vector<std::vector<double>> values, DeviationRule rule)
    : axes_(std::move(axes)), values_(std::move(values)), rule_(rule) {
  for (const auto& axis : axes_) {
    const bool rises = std::ranges::adjacent_find(axis, std::greater_equal<>()) == axis.end();
    if (axis.size() < 2 || !rises) {
      throw InputError("a field's grid needs two posts or more along each axis, in rising order");
    }
  }
  const std::size_t posts = axes_[0].size() * axes_[1].size() * axes_[2].size();
  for (const auto& list : values_) {
    if (list.empty() && &list != &values_.front()) continue;
    if (list.size() != posts) {
      throw InputError(
          fmt::format("a field's grid has {} posts, but {} values", posts, list.size()));
    }
    const auto bad = std::ranges::find_if_not(list, [](double v) { return std::isfinite(v); });
    if (bad == list.end()) continue;
    const auto at = static_cast<std::size_t>(bad - list.begin());
    throw InputError(fmt::format(
        "the value at ({:.6g}, {:.6g}, {:.6g}) is no number. Fill it, or give the "
        "material another field",
        axes_[0][at % axes_[0].size()], axes_[1][at / axes_[0].size() % axes_[1].size()],
        axes_[2][at / axes_[0].size() / axes_[1].size()]));
  }
}

std::size_t GridField::interval(int axis, double x) const {
  const auto& posts = axes_[axis];
  const auto above = std::upper_bound(posts.begin() + 1, posts.end() - 1, x);
  return static_cast<std::size_t>(above - posts.begin()) - 1;
}

double GridField::post(MaterialId material, std::size_t i, std::size_t j, std::size_t k) const {
  const auto& own = values_[std::min(index(material), values_.size() - 1)];
  const auto& list = own.empty() ? values_.front() : own;
  return list[(k * axes_[1].size() + j) * axes_[0].size() + i];
}

double GridField::value(const Vector3d& p, MaterialId material) const {
  std::array<std::size_t, 3> at;
  Vector3d t;
  for (int axis = 0; axis < 3; ++axis) {
    at[axis] = interval(axis, p[axis]);
    const double low = axes_[axis][at[axis]], high = axes_[axis][at[axis] + 1];
    t[axis] = std::clamp((p[axis] - low) / (high - low), 0.0, 1.0);
  }
  double sum = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    const std::size_t dx = k & 1, dy = k >> 1 & 1, dz = k >> 2;
    const double weight = (dx != 0 ? t.x() : 1 - t.x()) * (dy != 0 ? t.y() : 1 - t.y()) *
                          (dz != 0 ? t.z() : 1 - t.z());
    if (weight != 0) sum += weight * post(material, at[0] + dx, at[1] + dy, at[2] + dz);
  }
  return sum;
}

double GridField::largest_deviation(const LinearCell& approximation, MaterialId material,
                                    const MayHold& may_hold, double good_enough) const {
  if (rule_ == DeviationRule::kNativePoints) {
    return deviation_at_posts(approximation, material, may_hold);
  }
  // in each of the grid's boxes value and approximation differ by a trilinear function, which is
  // largest at a corner of any box inside
  const Barycentric cell(approximation.corners);
  const Vector3d low = low_corner(approximation.corners), high = high_corner(approximation.corners);
  std::array<std::vector<double>, 3> cuts;
  for (int axis = 0; axis < 3; ++axis) {
    cuts[axis].push_back(low[axis]);
    for (const double post : axes_[axis]) {
      if (post > low[axis] && post < high[axis]) cuts[axis].push_back(post);
    }
    cuts[axis].push_back(high[axis]);
  }
  double largest = 0;
  for (std::size_t k = 0; k + 1 < cuts[2].size(); ++k) {
    for (std::size_t j = 0; j + 1 < cuts[1].size(); ++j) {
      for (std::size_t i = 0; i + 1 < cuts[0].size(); ++i) {
        const Vector3d from(cuts[0][i], cuts[1][j], cuts[2][k]);
        const Vector3d to(cuts[0][i + 1], cuts[1][j + 1], cuts[2][k + 1]);
        largest = std::max(largest, deviation_in_box(from, to, approximation, cell, material,
                                                     may_hold, good_enough, kHalvings));
      }
    }
  }
  return largest;
}

double GridField::deviation_in_box(const Vector3d& low, const Vector3d& high,
                                   const LinearCell& approximation, const Barycentric& cell,
                                   MaterialId material, const MayHold& may_hold, double good_enough,
                                   int depth) const {
  if (!may_touch(cell, low, high)) return 0;
  const Vector3d centre = (low + high) / 2;
  double largest = 0;
  for (int k = 0; k < 8; ++k) {
    const Vector3d corner = corner_of(k, low, high);
    largest = std::max(largest, std::abs(value(corner, material) -
                                         cell.weights(corner).dot(approximation.values)));
  }
  if (largest == 0) return 0;
  if (may_hold && !may_hold(centre, (high - low).norm() / 2)) return 0;
  if (depth == 0 || largest <= good_enough) return largest;
  double tighter = 0;
  for (int k = 0; k < 8; ++k) {
    const Vector3d corner = corner_of(k, low, high);
    tighter = std::max(
        tighter, deviation_in_box(corner.cwiseMin(centre), corner.cwiseMax(centre), approximation,
                                  cell, material, may_hold, good_enough, depth - 1));
  }
  return tighter;
}

double GridField::deviation_at_posts(const LinearCell& approximation, MaterialId material,
                                     const MayHold& may_hold) const {
  const Barycentric cell(approximation.corners);
  const Vector3d low = low_corner(approximation.corners), high = high_corner(approximation.corners);
  std::array<std::size_t, 3> first, last;
  for (int axis = 0; axis < 3; ++axis) {
    first[axis] = std::ranges::lower_bound(axes_[axis], low[axis]) - axes_[axis].begin();
    last[axis] = std::ranges::upper_bound(axes_[axis], high[axis]) - axes_[axis].begin();
  }
  double largest = 0;
  for (std::size_t k = first[2]; k < last[2]; ++k) {
    for (std::size_t j = first[1]; j < last[1]; ++j) {
      for (std::size_t i = first[0]; i < last[0]; ++i) {
        const Vector3d p(axes_[0][i], axes_[1][j], axes_[2][k]);
        const Eigen::Vector4d weights = cell.weights(p);
        if (weights.minCoeff() < -1e-9 || (may_hold && !may_hold(p, 0))) continue;
        largest = std::max(largest,
                           std::abs(post(material, i, j, k) - weights.dot(approximation.values)));
      }
    }
  }
  return largest;
}

}  // namespace terrane::hierarchy::volume

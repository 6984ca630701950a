#include "hierarchy/collapse/moving_triangle.h"

#include <algorithm>
#include <cmath>

namespace terrane::hierarchy {
namespace {

// a split halves the time: down to 2^-12 of it
constexpr int kMostSplits = 12;

// of the largest coefficient: a triangle that becomes a line is 0 there but for rounding
constexpr double kRounding = 1e-12;

using Quadratic = std::array<double, 3>;
using Cubic = std::array<double, 4>;

/// The halves of a polynomial in Bernstein form (de Casteljau): the first one, and \p p the second.
template <std::size_t N>
std::array<double, N> split(std::array<double, N>& p) {
  std::array<double, N> first;
  for (std::size_t left = N; left > 0; --left) {
    first[N - left] = p[0];
    for (std::size_t i = 0; i + 1 < left; ++i) p[i] = (p[i] + p[i + 1]) / 2;
  }
  return first;
}

/// One sample over some part of the time.
struct Passage {
  std::array<Quadratic, 3> inside;  ///< all at least 0 while the sample is under the triangle
  std::array<Cubic, 2> room;        ///< both at least 0 while the triangle is within the tolerance
  double rounding;

  bool is_outside() const {
    return std::ranges::any_of(inside,
                               [](const Quadratic& q) { return q[0] < 0 && q[1] < 0 && q[2] < 0; });
  }
  bool has_room() const {
    return std::ranges::all_of(room, [this](const Cubic& c) {
      return std::min({c[0], c[1], c[2], c[3]}) >= -rounding;
    });
  }
  bool fails_at_begin() const {
    return std::ranges::all_of(inside, [](const Quadratic& q) { return q[0] >= 0; }) &&
           std::min(room[0][0], room[1][0]) < -rounding;
  }
  bool fails_at_end() const {
    return std::ranges::all_of(inside, [](const Quadratic& q) { return q[2] >= 0; }) &&
           std::min(room[0][3], room[1][3]) < -rounding;
  }
  Passage split_off_first() {
    Passage first{.rounding = rounding};
    for (std::size_t k = 0; k < 3; ++k) first.inside[k] = split(inside[k]);
    for (std::size_t k = 0; k < 2; ++k) first.room[k] = split(room[k]);
    return first;
  }
};

bool is_sound(Passage passage, int splits) {
  if (passage.is_outside() || passage.has_room()) return true;
  if (passage.fails_at_begin() || passage.fails_at_end()) return false;
  if (splits == 0) return true;
  const Passage first = passage.split_off_first();
  return is_sound(first, splits - 1) && is_sound(passage, splits - 1);
}

bool is_same(const FieldPoint& a, const FieldPoint& b) {
  return a.column == b.column && a.row == b.row && a.height_m == b.height_m;
}

}  // namespace

MovingTriangle::MovingTriangle(const std::array<FieldPoint, 3>& from,
                               const std::array<FieldPoint, 3>& to, double slack_cells)
    : from_(from), to_(to) {
  const double column = from[0].column, row = from[0].row;
  // twice the area of (p, q, sample), where p and q may be of different times
  const auto area = [&](const FieldPoint& p, const FieldPoint& q) {
    const double px = p.column - column, py = p.row - row;
    const double qx = q.column - column, qy = q.row - row;
    return Affine{py * qx - px * qy, qy - py, px - qx};
  };
  const auto mean = [](const Affine& a, const Affine& b) {
    return Affine{(a.constant + b.constant) / 2, (a.per_column + b.per_column) / 2,
                  (a.per_row + b.per_row) / 2};
  };
  whole_ = {0, 0, 0};
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t p = (k + 1) % 3, q = (k + 2) % 3;
    areas_[k] = {area(from[p], from[q]), mean(area(from[p], to[q]), area(to[p], from[q])),
                 area(to[p], to[q])};
    for (std::size_t i = 0; i < 3; ++i) whole_[i] += areas_[k][i].constant;
    longest =
        std::max(longest, std::hypot(from[p].column - from[q].column, from[p].row - from[q].row));
  }
  slack_ = slack_cells * longest / whole_[0];
}

bool MovingTriangle::stays_within(const FieldSample& sample, double tolerance_m) const {
  const double column = sample.column - from_[0].column, row = sample.row - from_[0].row;
  Passage passage{.rounding = 0};
  Cubic off{0, 0, 0, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    Quadratic& area = passage.inside[k];
    for (std::size_t i = 0; i < 3; ++i) area[i] = areas_[k][i].at(column, row);
    const double first = from_[k].height_m - sample.height_m;
    const double last = to_[k].height_m - sample.height_m;
    off[0] += area[0] * first;
    off[1] += (area[0] * last + 2 * area[1] * first) / 3;
    off[2] += (2 * area[1] * last + area[2] * first) / 3;
    off[3] += area[2] * last;
    for (std::size_t i = 0; i < 3; ++i) area[i] += slack_ * whole_[i];
  }
  if (passage.is_outside()) return true;
  const Cubic whole{whole_[0], (whole_[0] + 2 * whole_[1]) / 3, (2 * whole_[1] + whole_[2]) / 3,
                    whole_[2]};
  for (std::size_t i = 0; i < 4; ++i) {
    passage.room[0][i] = tolerance_m * whole[i] - off[i];
    passage.room[1][i] = tolerance_m * whole[i] + off[i];
    passage.rounding = std::max(passage.rounding, std::abs(off[i]));
  }
  passage.rounding = kRounding * (passage.rounding + tolerance_m * whole_[0]);
  return is_sound(passage, kMostSplits);
}

bool MovingTriangle::stays_within(const SampleField& field, double tolerance_m) const {
  // a point under the triangle is at any time between two that are under it at the ends
  std::array<FieldPoint, 6> corners{from_[0], from_[1], from_[2]};
  std::size_t count = 3;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!is_same(from_[k], to_[k])) corners[count++] = to_[k];
  }
  if (count == 3) return true;
  return for_each_sample_of_hull(
      std::span(corners).first(count), field, field.slack_cells,
      [&](const FieldSample& sample) { return stays_within(sample, tolerance_m); });
}

}  // namespace terrane::hierarchy

#include "hierarchy/collapse/moving_triangle.h"

#include <algorithm>
#include <cmath>

#include "hierarchy/collapse/bernstein.h"

namespace terrane::hierarchy {
namespace {

// a split halves the time: down to 2^-10 of it
constexpr int kMostSplits = 10;

// of the largest coefficient: a triangle that becomes a line is 0 there but for rounding
constexpr double kRounding = 1e-12;

/// One sample over some part of the time.
struct Passage {
  std::array<Quadratic, 3> inside;  ///< all at least 0 while the sample is under the triangle
  Cubic room;  ///< at least 0 while the triangle is not too high over it, or too low
  std::array<double, 3> begin_room_m, end_room_m;  ///< the same for each corner
  double rounding;

  bool is_outside() const {
    return std::ranges::any_of(inside,
                               [](const Quadratic& q) { return q[0] < 0 && q[1] < 0 && q[2] < 0; });
  }
  bool has_room() const {
    return room[0] >= -rounding && room[1] >= -rounding && room[2] >= -rounding &&
           room[3] >= -rounding;
  }
  /// Then all between the corners has room, however the sample passes.
  bool have_corners_room() const {
    return std::min({begin_room_m[0], begin_room_m[1], begin_room_m[2], end_room_m[0],
                     end_room_m[1], end_room_m[2]}) >= 0;
  }
  bool fails_at_begin() const {
    return room[0] < -rounding && inside[0][0] >= 0 && inside[1][0] >= 0 && inside[2][0] >= 0;
  }
  bool fails_at_end() const {
    return room[3] < -rounding && inside[0][2] >= 0 && inside[1][2] >= 0 && inside[2][2] >= 0;
  }
  Passage split_off_first() {
    Passage first = *this;
    first.room = split(room);
    for (std::size_t k = 0; k < 3; ++k) {
      first.inside[k] = split(inside[k]);
      first.end_room_m[k] = begin_room_m[k] = (begin_room_m[k] + end_room_m[k]) / 2;
    }
    return first;
  }
};

bool is_sound(const Passage& passage, int splits) {
  if (passage.has_room() || passage.is_outside() || passage.have_corners_room()) return true;
  if (passage.fails_at_begin() || passage.fails_at_end()) return false;
  if (splits == 0) return true;
  Passage second = passage;
  const Passage first = second.split_off_first();
  return is_sound(first, splits - 1) && is_sound(second, splits - 1);
}

}  // namespace

MovingTriangle::MovingTriangle(const std::array<FieldPoint, 3>& from,
                               const std::array<FieldPoint, 3>& to, double slack_cells)
    : from_(from), to_(to) {
  const double column = from[0].column, row = from[0].row;
  for (const auto* corners : {&from, &to}) {
    for (const FieldPoint& corner : *corners) {
      lowest_m_ = std::min(lowest_m_, corner.height_m);
      highest_m_ = std::max(highest_m_, corner.height_m);
    }
  }
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
  double longest2 = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t p = (k + 1) % 3, q = (k + 2) % 3;
    areas_[k] = {area(from[p], from[q]), mean(area(from[p], to[q]), area(to[p], from[q])),
                 area(to[p], to[q])};
    for (std::size_t i = 0; i < 3; ++i) whole_[i] += areas_[k][i].constant;
    const double x = from[p].column - from[q].column, y = from[p].row - from[q].row;
    longest2 = std::max(longest2, x * x + y * y);
  }
  slack_ = slack_cells * std::sqrt(longest2) / whole_[0];
}

bool MovingTriangle::is_near_all_corners(double height_m, double tolerance_m) const {
  return height_m >= highest_m_ - tolerance_m && height_m <= lowest_m_ + tolerance_m;
}

bool MovingTriangle::stays_within(const FieldSample& sample, double tolerance_m,
                                  double slack) const {
  if (is_near_all_corners(sample.height_m, tolerance_m)) return true;
  const double column = sample.column - from_[0].column, row = sample.row - from_[0].row;
  Passage passage{.inside = {},
                  .room = {},
                  .begin_room_m = {},
                  .end_room_m = {},
                  .rounding = tolerance_m * whole_[0]};
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
    for (std::size_t i = 0; i < 3; ++i) area[i] += slack * whole_[i];
  }
  if (passage.is_outside()) return true;
  const Cubic whole = elevated(whole_);
  for (const double o : off) passage.rounding = std::max(passage.rounding, std::abs(o));
  passage.rounding *= kRounding;
  for (const double sign : {-1.0, 1.0}) {
    for (std::size_t i = 0; i < 4; ++i) {
      passage.room[i] = tolerance_m * whole[i] + sign * off[i];
    }
    for (std::size_t k = 0; k < 3; ++k) {
      passage.begin_room_m[k] = tolerance_m + sign * (from_[k].height_m - sample.height_m);
      passage.end_room_m[k] = tolerance_m + sign * (to_[k].height_m - sample.height_m);
    }
    if (!is_sound(passage, kMostSplits)) return false;
  }
  return true;
}

int MovingTriangle::meeting_corners() const {
  const int pairs = (to_[0] == to_[1]) + (to_[1] == to_[2]) + (to_[2] == to_[0]);
  return pairs == 0 ? 0 : pairs == 1 ? 2 : 3;
}

}  // namespace terrane::hierarchy

#include "hierarchy/collapse/moving_triangle.h"

#include <algorithm>
#include <cmath>
#include <experimental/simd>

namespace terrane::hierarchy {
namespace {

// a split halves the time: down to 2^-10 of it
constexpr int kMostSplits = 10;

// of the largest coefficient: a triangle that becomes a line is 0 there but for rounding
constexpr double kRounding = 1e-12;

namespace stdx = std::experimental;
constexpr std::int64_t kLanes = 4;
using Lanes = stdx::simd<float, stdx::simd_abi::deduce_t<float, kLanes>>;

// what single precision may be off by, as a share of the largest area times the largest height
constexpr double kDoubt = 4e-6;

using Quadratic = std::array<double, 3>;
using Cubic = std::array<double, 4>;

/// The same polynomial with one degree more.
Cubic elevated(const Quadratic& q) {
  return {q[0], (q[0] + 2 * q[1]) / 3, (2 * q[1] + q[2]) / 3, q[2]};
}

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
  Cubic room;  ///< at least 0 while the triangle is not too high over it, or too low
  double rounding;

  bool is_outside() const {
    return std::ranges::any_of(inside,
                               [](const Quadratic& q) { return q[0] < 0 && q[1] < 0 && q[2] < 0; });
  }
  bool has_room() const {
    return room[0] >= -rounding && room[1] >= -rounding && room[2] >= -rounding &&
           room[3] >= -rounding;
  }
  bool fails_at_begin() const {
    return room[0] < -rounding && inside[0][0] >= 0 && inside[1][0] >= 0 && inside[2][0] >= 0;
  }
  bool fails_at_end() const {
    return room[3] < -rounding && inside[0][2] >= 0 && inside[1][2] >= 0 && inside[2][2] >= 0;
  }
  Passage split_off_first() {
    Passage first{.inside = {}, .room = split(room), .rounding = rounding};
    for (std::size_t k = 0; k < 3; ++k) first.inside[k] = split(inside[k]);
    return first;
  }
};

bool is_sound(const Passage& passage, int splits) {
  if (passage.has_room() || passage.is_outside()) return true;
  if (passage.fails_at_begin() || passage.fails_at_end()) return false;
  if (splits == 0) return true;
  Passage second = passage;
  const Passage first = second.split_off_first();
  return is_sound(first, splits - 1) && is_sound(second, splits - 1);
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
  Passage passage{.inside = {}, .room = {}, .rounding = tolerance_m * whole_[0]};
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
  const Cubic whole = elevated(whole_);
  for (const double o : off) passage.rounding = std::max(passage.rounding, std::abs(o));
  passage.rounding *= kRounding;
  for (const double sign : {-1.0, 1.0}) {
    for (std::size_t i = 0; i < 4; ++i) {
      passage.room[i] = tolerance_m * whole[i] + sign * off[i];
    }
    if (!is_sound(passage, kMostSplits)) return false;
  }
  return true;
}

/// Goes through rows of samples, four at once in single precision. What that cannot clear of all
/// doubt is judged one by one.
class MovingTriangle::RowSweep {
 public:
  RowSweep(const MovingTriangle& triangle, double tolerance_m)
      : triangle_(triangle), tolerance_m_(tolerance_m) {
    double reach = 0, relief_m = tolerance_m;
    const FieldPoint& origin = triangle.from_[0];
    for (std::size_t k = 0; k < 3; ++k) {
      for (const FieldPoint* p : {&triangle.from_[k], &triangle.to_[k]}) {
        reach =
            std::max({reach, std::abs(p->column - origin.column), std::abs(p->row - origin.row)});
        relief_m = std::max(relief_m, std::abs(p->height_m - origin.height_m));
      }
      first_m_[k] = static_cast<float>(triangle.from_[k].height_m - origin.height_m);
      last_m_[k] = static_cast<float>(triangle.to_[k].height_m - origin.height_m);
      for (std::size_t i = 0; i < 3; ++i) {
        per_column_[k][i] = static_cast<float>(triangle.areas_[k][i].per_column);
      }
    }
    const double area_doubt = kDoubt * (reach + 4) * (reach + 4);
    const std::array<double, 3>& whole = triangle.whole_;
    const Cubic raised = elevated(whole);
    for (std::size_t i = 0; i < 4; ++i) {
      room_[i] = static_cast<float>(tolerance_m * raised[i] - 8 * area_doubt * relief_m);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      outside_[i] = static_cast<float>(-triangle.slack_ * std::max(0.0, whole[i]) - area_doubt);
    }
    highest_m_ = static_cast<float>(2 * (relief_m + tolerance_m));
  }

  bool operator()(const SampleField& field, std::int64_t row, std::int64_t first,
                  std::int64_t last) {
    const FieldPoint& origin = triangle_.from_[0];
    const double y = static_cast<double>(row) - origin.row;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 3; ++i) {
        const Affine& area = triangle_.areas_[k][i];
        at_row_[k][i] = static_cast<float>(area.constant + y * area.per_row);
      }
    }
    const double* heights = field.row(row);
    for (std::int64_t column = first; column <= last; column += kLanes) {
      const std::int64_t end = std::min(column + kLanes, last + 1);
      const Lanes height_m([&](auto lane) {
        const std::int64_t at = std::min(column + static_cast<std::int64_t>(lane), end - 1);
        return static_cast<float>(heights[at] - origin.height_m);
      });
      const Lanes x([&](auto lane) {
        const std::int64_t at = std::min(column + static_cast<std::int64_t>(lane), end - 1);
        return static_cast<float>(static_cast<double>(at) - origin.column);
      });
      if (is_cleared(x, height_m)) continue;
      for (std::int64_t at = column; at < end; ++at) {
        if (std::isnan(heights[at])) continue;
        const FieldSample sample{static_cast<float>(at), static_cast<float>(row), heights[at]};
        if (!triangle_.stays_within(sample, tolerance_m_)) return false;
      }
    }
    return true;
  }

 private:
  bool is_cleared(const Lanes& x, const Lanes& height_m) const {
    Lanes off[4] = {0.0F, 0.0F, 0.0F, 0.0F};
    Lanes::mask_type is_outside(false);
    for (std::size_t k = 0; k < 3; ++k) {
      const Lanes begin = at_row_[k][0] + x * per_column_[k][0];
      const Lanes middle = at_row_[k][1] + x * per_column_[k][1];
      const Lanes end = at_row_[k][2] + x * per_column_[k][2];
      is_outside = is_outside || (begin < outside_[0] && middle < outside_[1] && end < outside_[2]);
      const Lanes first = first_m_[k] - height_m, last = last_m_[k] - height_m;
      constexpr float kThird = 1.0F / 3;
      off[0] += begin * first;
      off[1] += (begin * last + 2.0F * middle * first) * kThird;
      off[2] += (2.0F * middle * last + end * first) * kThird;
      off[3] += end * last;
    }
    const auto has_room = stdx::abs(off[0]) <= room_[0] && stdx::abs(off[1]) <= room_[1] &&
                          stdx::abs(off[2]) <= room_[2] && stdx::abs(off[3]) <= room_[3] &&
                          stdx::abs(height_m) <= highest_m_;
    return stdx::all_of(is_outside || has_room);
  }

  const MovingTriangle& triangle_;
  double tolerance_m_;
  float per_column_[3][3], at_row_[3][3], first_m_[3], last_m_[3];
  float room_[4], outside_[3], highest_m_;
};

bool MovingTriangle::stays_within(const SampleField& field, double tolerance_m) const {
  // a point under the triangle is at any time between two that are under it at the ends
  std::array<FieldPoint, 6> corners{from_[0], from_[1], from_[2]};
  std::size_t count = 3;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!is_same(from_[k], to_[k])) corners[count++] = to_[k];
  }
  if (count == 3) return true;
  const std::span<const FieldPoint> hull = std::span(corners).first(count);
  if (field.is_reduced()) {
    return for_each_kept_of_hull(hull, field, field.slack_cells, [&](const FieldSample& sample) {
      return stays_within(sample, tolerance_m);
    });
  }
  RowSweep sweep(*this, tolerance_m);
  return for_each_span_of_hull(hull, {field.columns, field.rows}, field.slack_cells,
                               [&](std::int64_t row, std::int64_t first, std::int64_t last) {
                                 return sweep(field, row, first, last);
                               });
}

}  // namespace terrane::hierarchy

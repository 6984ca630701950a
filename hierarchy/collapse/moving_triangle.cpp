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
constexpr double kDoubt = 8e-6;

// splits that four samples take together before each is looked at alone
constexpr int kSplitsAtOnce = 3;

using Quadratic = std::array<double, 3>;
using Cubic = std::array<double, 4>;

/// The same polynomial with one degree more.
Cubic elevated(const Quadratic& q) {
  return {q[0], (q[0] + 2 * q[1]) / 3, (2 * q[1] + q[2]) / 3, q[2]};
}

/// The halves of a polynomial in Bernstein form (de Casteljau): the first one, and \p p the second.
template <class Value, std::size_t N>
std::array<Value, N> split(std::array<Value, N>& p) {
  std::array<Value, N> first;
  for (std::size_t left = N; left > 0; --left) {
    first[N - left] = p[0];
    for (std::size_t i = 0; i + 1 < left; ++i) p[i] = (p[i] + p[i + 1]) * Value(0.5F);
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

int MovingTriangle::meeting_corners() const {
  const int pairs = is_same(to_[0], to_[1]) + is_same(to_[1], to_[2]) + is_same(to_[2], to_[0]);
  return pairs == 0 ? 0 : pairs == 1 ? 2 : 3;
}

/// Goes through samples, four at once in single precision. What that cannot clear of all doubt is
/// judged one by one.
class MovingTriangle::Sweep {
 public:
  Sweep(const MovingTriangle& triangle, double tolerance_m)
      : triangle_(triangle), tolerance_m_(tolerance_m), meeting_(triangle.meeting_corners()) {
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
        constant_[k][i] = static_cast<float>(triangle.areas_[k][i].constant);
        per_column_[k][i] = static_cast<float>(triangle.areas_[k][i].per_column);
        per_row_[k][i] = static_cast<float>(triangle.areas_[k][i].per_row);
      }
    }
    const double area_doubt = kDoubt * (reach + 4) * (reach + 4);
    const std::array<double, 3>& whole = triangle.whole_;
    const Cubic raised = elevated(whole);
    for (std::size_t i = 0; i < 4; ++i) {
      limits_.room[i] = static_cast<float>(tolerance_m * raised[i] - 8 * area_doubt * relief_m);
    }
    for (std::size_t i = 4 - vanishing(); i < 4; ++i) limits_.room[i] = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      limits_.outside[i] =
          static_cast<float>(-triangle.slack_ * std::max(0.0, whole[i]) - area_doubt);
    }
    highest_m_ = static_cast<float>(2 * (relief_m + tolerance_m));
  }

  /// Part of a row of a field.
  bool operator()(const SampleField& field, std::int64_t row, std::int64_t first,
                  std::int64_t last) const {
    const FieldPoint& origin = triangle_.from_[0];
    const Lanes y = static_cast<float>(static_cast<double>(row) - origin.row);
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
      const Mask in_doubt = !are_cleared(x, y, height_m);
      if (stdx::none_of(in_doubt)) continue;
      for (std::int64_t at = column; at < end; ++at) {
        if (!in_doubt[static_cast<std::size_t>(at - column)] || std::isnan(heights[at])) continue;
        const FieldSample sample{static_cast<float>(at), static_cast<float>(row), heights[at]};
        if (!triangle_.stays_within(sample, tolerance_m_)) return false;
      }
    }
    return true;
  }

  /// Any samples that have heights.
  bool operator()(std::span<const FieldSample> samples) const {
    const FieldPoint& origin = triangle_.from_[0];
    for (std::size_t first = 0; first < samples.size(); first += kLanes) {
      const auto four =
          samples.subspan(first, std::min<std::size_t>(kLanes, samples.size() - first));
      const auto at = [&](auto lane) -> const FieldSample& {
        return four[std::min<std::size_t>(lane, four.size() - 1)];
      };
      const Lanes x([&](auto k) { return static_cast<float>(at(k).column - origin.column); });
      const Lanes y([&](auto k) { return static_cast<float>(at(k).row - origin.row); });
      const Lanes height_m(
          [&](auto k) { return static_cast<float>(at(k).height_m - origin.height_m); });
      const Mask in_doubt = !are_cleared(x, y, height_m);
      if (stdx::none_of(in_doubt)) continue;
      for (std::size_t k = 0; k < four.size(); ++k) {
        if (in_doubt[k] && !triangle_.stays_within(four[k], tolerance_m_)) return false;
      }
    }
    return true;
  }

 private:
  using Mask = Lanes::mask_type;

  /// What four samples are held against over some part of the time.
  struct Limits {
    std::array<float, 4> room;     // more off than that may be over the tolerance
    std::array<float, 3> outside;  // an area less than that is surely outside
  };

  /// Four samples over some part of the time; all in Bernstein form.
  struct Passages {
    std::array<std::array<Lanes, 3>, 3> inside;
    std::array<Lanes, 4> off;

    Mask are_outside(const Limits& limits) const {
      Mask outside(false);
      for (const std::array<Lanes, 3>& area : inside) {
        outside = outside || (area[0] < limits.outside[0] && area[1] < limits.outside[1] &&
                              area[2] < limits.outside[2]);
      }
      return outside;
    }
    Mask have_room(const Limits& limits) const {
      return stdx::abs(off[0]) <= limits.room[0] && stdx::abs(off[1]) <= limits.room[1] &&
             stdx::abs(off[2]) <= limits.room[2] && stdx::abs(off[3]) <= limits.room[3];
    }
  };

  /// Where corners meet at t = 1, areas and heights off are (1 - t) times something, or (1 - t)^2
  /// times if all do: so many of the last coefficients are 0, and there is nothing to doubt.
  std::size_t vanishing() const {
    return meeting_ == 0 ? 0 : static_cast<std::size_t>(meeting_) - 1;
  }

  Mask are_cleared(const Lanes& x, const Lanes& y, const Lanes& height_m) const {
    Passages all{.inside = {}, .off = {0.0F, 0.0F, 0.0F, 0.0F}};
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<Lanes, 3>& area = all.inside[k];
      for (std::size_t i = 0; i < 3; ++i) {
        area[i] = constant_[k][i] + y * per_row_[k][i] + x * per_column_[k][i];
      }
      const Lanes first = first_m_[k] - height_m, last = last_m_[k] - height_m;
      constexpr float kThird = 1.0F / 3;
      all.off[0] += area[0] * first;
      all.off[1] += (area[0] * last + 2.0F * area[1] * first) * kThird;
      all.off[2] += (2.0F * area[1] * last + area[2] * first) * kThird;
      all.off[3] += area[2] * last;
    }
    for (std::size_t i = 4 - vanishing(); i < 4; ++i) all.off[i] = 0.0F;
    return stdx::abs(height_m) <= highest_m_ && are_sound(all, limits_, kSplitsAtOnce);
  }

  static Mask are_sound(const Passages& passages, const Limits& limits, int splits) {
    const Mask sound = passages.have_room(limits) || passages.are_outside(limits);
    if (splits == 0 || stdx::all_of(sound)) return sound;
    Passages second = passages, first;
    for (std::size_t k = 0; k < 3; ++k) first.inside[k] = split(second.inside[k]);
    first.off = split(second.off);
    Limits after = limits, before;
    before.room = split(after.room);
    before.outside = split(after.outside);
    return sound || (are_sound(first, before, splits - 1) && are_sound(second, after, splits - 1));
  }

  const MovingTriangle& triangle_;
  double tolerance_m_;
  int meeting_;
  float constant_[3][3], per_column_[3][3], per_row_[3][3], first_m_[3], last_m_[3];
  Limits limits_;
  float highest_m_;
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
  const Sweep sweep(*this, tolerance_m);
  if (field.is_reduced()) return for_each_kept_run_of_hull(hull, field, field.slack_cells, sweep);
  return for_each_span_of_hull(hull, {field.columns, field.rows}, field.slack_cells,
                               [&](std::int64_t row, std::int64_t first, std::int64_t last) {
                                 return sweep(field, row, first, last);
                               });
}

}  // namespace terrane::hierarchy

#include "hierarchy/collapse/moving_triangle.h"

#include <algorithm>
#include <cmath>

#include "hierarchy/collapse/lanes.h"

namespace terrane::hierarchy {
namespace {

// a split halves the time: down to 2^-10 of it
constexpr int kMostSplits = 10;

// of the largest coefficient: a triangle that becomes a line is 0 there but for rounding
constexpr double kRounding = 1e-12;

// what single precision may be off by, as a share of the largest area times the largest height
constexpr double kDoubt = 8e-6;

// splits that eight samples take together before each is looked at alone
constexpr int kSplitsAtOnce = 3;

using Quadratic = std::array<double, 3>;
using Cubic = std::array<double, 4>;

/// The same polynomial with one degree more.
Cubic elevated(const Quadratic& q) {
  return {q[0], (q[0] + 2 * q[1]) / 3, (2 * q[1] + q[2]) / 3, q[2]};
}

/// The halves of a polynomial in Bernstein form (de Casteljau): the first one, and \p p the second.
template <class Value, std::size_t N>
TERRANE_LANES_INLINE std::array<Value, N> split(std::array<Value, N>& p) {
  std::array<Value, N> first;
  for (std::size_t left = N; left > 0; --left) {
    first[N - left] = p[0];
    for (std::size_t i = 0; i + 1 < left; ++i) p[i] = (p[i] + p[i + 1]) * 0.5F;
  }
  return first;
}

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

bool is_same(const FieldPoint& a, const FieldPoint& b) {
  return a.column == b.column && a.row == b.row && a.height_m == b.height_m;
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

bool MovingTriangle::stays_within(const FieldSample& sample, double tolerance_m) const {
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
    for (std::size_t k = 0; k < 3; ++k) {
      passage.begin_room_m[k] = tolerance_m + sign * (from_[k].height_m - sample.height_m);
      passage.end_room_m[k] = tolerance_m + sign * (to_[k].height_m - sample.height_m);
    }
    if (!is_sound(passage, kMostSplits)) return false;
  }
  return true;
}

int MovingTriangle::meeting_corners() const {
  const int pairs = is_same(to_[0], to_[1]) + is_same(to_[1], to_[2]) + is_same(to_[2], to_[0]);
  return pairs == 0 ? 0 : pairs == 1 ? 2 : 3;
}

/// Goes through samples, eight at once in single precision. What that cannot clear of all doubt is
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
    const double doubt_m = kDoubt * (relief_m + tolerance_m);
    near_from_m_ =
        static_cast<float>(triangle.highest_m_ - tolerance_m + doubt_m - origin.height_m);
    near_to_m_ = static_cast<float>(triangle.lowest_m_ + tolerance_m - doubt_m - origin.height_m);
  }

  /// Part of a row of a field.
  bool operator()(const SampleField& field, std::int64_t row, std::int64_t first,
                  std::int64_t last) const {
    const double* heights = field.row(row);
    return in_eights(RowSamples{heights + first, static_cast<double>(first),
                                static_cast<double>(row), triangle_.from_[0],
                                static_cast<std::size_t>(last - first + 1)});
  }

  /// Any samples that have heights.
  bool operator()(std::span<const FieldSample> samples) const {
    return in_eights(KeptSamples{samples, triangle_.from_[0]});
  }

 private:
  /// What samples are held against over some part of the time.
  struct Limits {
    std::array<float, 4> room;     // more off than that may be over the tolerance
    std::array<float, 3> outside;  // an area less than that is surely outside
  };

  /// Eight samples over some part of the time; all in Bernstein form.
  struct Passages {
    std::array<std::array<Lanes, 3>, 3> inside;
    std::array<Lanes, 4> off;

    TERRANE_LANES_INLINE LaneMask are_outside(const Limits& limits) const {
      LaneMask outside{};
      for (const std::array<Lanes, 3>& area : inside) {
        outside |= (area[0] < limits.outside[0]) & (area[1] < limits.outside[1]) &
                   (area[2] < limits.outside[2]);
      }
      return outside;
    }
    TERRANE_LANES_INLINE LaneMask have_room(const Limits& limits) const {
      LaneMask room = ~LaneMask{};
      for (std::size_t i = 0; i < 4; ++i) room &= abs(off[i]) <= limits.room[i];
      return room;
    }
  };

  /// Eight samples, counted from a corner.
  struct Eight {
    Lanes x, y, height_m;
  };

  /// Samples of a row.
  struct RowSamples {
    const double* all_heights_m;
    double first_column, row;
    const FieldPoint& origin;
    std::size_t count;

    FieldSample operator[](std::size_t k) const {
      return {static_cast<float>(first_column + static_cast<double>(k)), static_cast<float>(row),
              all_heights_m[k]};
    }
    TERRANE_LANES_INLINE Lanes heights_m(std::size_t first) const {
      Lanes result{};
      const double* from = all_heights_m + first;
      if (first + kLanes <= count) {
        for (std::size_t k = 0; k < kLanes; ++k) {
          result[k] = static_cast<float>(from[k] - origin.height_m);
        }
        return result;
      }
      for (std::size_t k = 0; k < kLanes; ++k) {
        const std::size_t at = std::min(k, count - first - 1);
        result[k] = static_cast<float>(from[at] - origin.height_m);
      }
      return result;
    }
    TERRANE_LANES_INLINE Eight eight(std::size_t first, const Lanes& height_m) const {
      const auto x = static_cast<float>(first_column - origin.column + static_cast<double>(first));
      const auto last = static_cast<float>(std::min(kLanes, count - first) - 1);
      return {x + min(lane_numbers(), all_lanes(last)),
              all_lanes(static_cast<float>(row - origin.row)), height_m};
    }
  };

  /// Samples of a reduced field.
  struct KeptSamples {
    std::span<const FieldSample> samples;
    const FieldPoint& origin;
    std::size_t count = samples.size();

    FieldSample operator[](std::size_t k) const { return samples[k]; }
    TERRANE_LANES_INLINE Lanes heights_m(std::size_t first) const {
      Lanes result{};
      for (std::size_t k = 0; k < kLanes; ++k) {
        const FieldSample& sample = samples[std::min(first + k, count - 1)];
        result[k] = static_cast<float>(sample.height_m - origin.height_m);
      }
      return result;
    }
    TERRANE_LANES_INLINE Eight eight(std::size_t first, const Lanes& height_m) const {
      Eight eight{{}, {}, height_m};
      for (std::size_t k = 0; k < kLanes; ++k) {
        const FieldSample& sample = samples[std::min(first + k, count - 1)];
        eight.x[k] = static_cast<float>(sample.column - origin.column);
        eight.y[k] = static_cast<float>(sample.row - origin.row);
      }
      return eight;
    }
  };

  /// The first eight samples, from some on, that are not all cleared.
  struct Doubt {
    std::size_t first;
    std::uint32_t samples;  // a bit for each of them that is not
  };

  template <class Samples>
  struct Clearing {
    const Sweep& sweep;
    const Samples& samples;
    std::size_t begin;

    TERRANE_LANES_INLINE Doubt run() const {
      for (std::size_t first = begin; first < samples.count; first += kLanes) {
        const Lanes height_m = samples.heights_m(first);
        // samples without data are as good as cleared
        const LaneMask is_known = (height_m != height_m) | ((height_m >= sweep.near_from_m_) &
                                                            (height_m <= sweep.near_to_m_));
        if (!any(~is_known)) continue;
        const Eight eight = samples.eight(first, height_m);
        const LaneMask is_cleared =
            is_known | ((abs(height_m) <= sweep.highest_m_) &
                        are_sound<kSplitsAtOnce>(sweep.passages(eight), sweep.limits_, is_known));
        if (any(~is_cleared)) return {first, bits_of(~is_cleared)};
      }
      return {samples.count, 0};
    }
  };

  template <class Samples>
  bool in_eights(const Samples& samples) const {
    for (std::size_t begin = 0; begin < samples.count; begin += kLanes) {
      const Clearing<Samples> clearing{*this, samples, begin};
      const Doubt doubt = has_wide_lanes() ? run_wide(clearing) : run_portable(clearing);
      begin = doubt.first;
      for (std::size_t k = 0; k < kLanes && begin + k < samples.count; ++k) {
        if ((doubt.samples >> k & 1) == 0) continue;
        const FieldSample sample = samples[begin + k];
        if (!std::isnan(sample.height_m) && !triangle_.stays_within(sample, tolerance_m_)) {
          return false;
        }
      }
    }
    return true;
  }

  /// Where corners meet at t = 1, areas and heights off are (1 - t) times something, or (1 - t)^2
  /// times if all do: so many of the last coefficients are 0, and there is nothing to doubt.
  std::size_t vanishing() const {
    return meeting_ == 0 ? 0 : static_cast<std::size_t>(meeting_) - 1;
  }

  TERRANE_LANES_INLINE Passages passages(const Eight& eight) const {
    Passages all{};
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<Lanes, 3>& area = all.inside[k];
      for (std::size_t i = 0; i < 3; ++i) {
        area[i] = constant_[k][i] + eight.y * per_row_[k][i] + eight.x * per_column_[k][i];
      }
      const Lanes first = first_m_[k] - eight.height_m, last = last_m_[k] - eight.height_m;
      constexpr float kThird = 1.0F / 3;
      all.off[0] += area[0] * first;
      all.off[1] += (area[0] * last + 2.0F * area[1] * first) * kThird;
      all.off[2] += (2.0F * area[1] * last + area[2] * first) * kThird;
      all.off[3] += area[2] * last;
    }
    for (std::size_t i = 4 - vanishing(); i < 4; ++i) all.off[i] = Lanes{};
    return all;
  }

  /// \param known  samples that need no look.
  template <int kSplits>
  TERRANE_LANES_INLINE static LaneMask are_sound(const Passages& passages, const Limits& limits,
                                                 const LaneMask& known) {
    LaneMask sound = known | passages.have_room(limits) | passages.are_outside(limits);
    if constexpr (kSplits > 0) {
      if (!any(~sound)) return sound;
      Passages second = passages, first;
      for (std::size_t k = 0; k < 3; ++k) first.inside[k] = split(second.inside[k]);
      first.off = split(second.off);
      Limits after = limits, before;
      before.room = split(after.room);
      before.outside = split(after.outside);
      const LaneMask at_first = are_sound<kSplits - 1>(first, before, sound);
      // what fails in the first half is in doubt, whatever comes
      if (any(at_first & ~sound)) {
        sound = at_first & are_sound<kSplits - 1>(second, after, sound | ~at_first);
      }
    }
    return sound;
  }

  const MovingTriangle& triangle_;
  double tolerance_m_;
  int meeting_;
  float constant_[3][3], per_column_[3][3], per_row_[3][3], first_m_[3], last_m_[3];
  Limits limits_;
  float highest_m_;
  float near_from_m_, near_to_m_;  // heights that are near those of all corners
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
  if (field.is_reduced()) {
    // the few first: most that is refused is so by them
    const bool is_near_kept = for_each_kept_run_of_hull(hull, field, field.slack_cells, sweep);
    if (!is_near_kept || !field.is_backed()) return is_near_kept;
  }
  return for_each_span_of_hull(hull, {field.columns, field.rows}, field.slack_cells,
                               [&](std::int64_t row, std::int64_t first, std::int64_t last) {
                                 return sweep(field, row, first, last);
                               });
}

}  // namespace terrane::hierarchy

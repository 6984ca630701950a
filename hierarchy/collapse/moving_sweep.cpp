// A moving triangle and all samples of a field.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "hierarchy/collapse/bernstein.h"
#include "hierarchy/collapse/coded_lanes.h"
#include "hierarchy/collapse/halfway_plane.h"
#include "hierarchy/collapse/height_slabs.h"
#include "hierarchy/collapse/lanes.h"
#include "hierarchy/collapse/moving_triangle.h"
#include "hierarchy/collapse/slab_parts.h"

namespace terrane::hierarchy {
namespace {

// what single precision may be off by, as a share of the largest area times the largest height
constexpr double kDoubt = 8e-6;

// splits that eight samples take together before each is looked at alone
constexpr int kSplitsAtOnce = 3;
constexpr int kSplitsOfSlab = 4;

// samples looked at may lie so far beside a triangle's corners, in cells
constexpr double kMargin = 4;

/// A row of one of a slab's planes.
struct SlabRow {
  double first_m, per_column_m;

  double operator[](std::size_t k) const { return first_m + static_cast<double>(k) * per_column_m; }
};

/// Eight heights of a row, counted from some height.
template <class Heights>
TERRANE_LANES_INLINE Lanes lanes_of(const Heights& heights_m, std::size_t first, double origin_m) {
  Lanes result{};
  for (std::size_t k = 0; k < kLanes; ++k) {
    result[k] = static_cast<float>(heights_m[first + k] - origin_m);
  }
  return result;
}

TERRANE_LANES_INLINE Lanes lanes_of(const CodedHeights::Row& heights, std::size_t first,
                                    double origin_m) {
  const auto [low_m, high_m] = lanes_of(heights, first);
  using HalfFloats [[gnu::vector_size(2 * kLanes)]] = float;
  return __builtin_shufflevector(__builtin_convertvector(low_m - origin_m, HalfFloats),
                                 __builtin_convertvector(high_m - origin_m, HalfFloats), 0, 1, 2, 3,
                                 4, 5, 6, 7);
}

}  // namespace

/// Goes through samples, eight at once in single precision. What that cannot clear of all doubt is
/// judged one by one.
class MovingTriangle::Sweep {
 public:
  /// \param margin_cells  how far beside the triangle there may be samples and corners of slabs.
  /// \param left  set to the sample that the triangle is found to leave.
  Sweep(const MovingTriangle& triangle, double tolerance_m, double margin_cells,
        std::optional<FieldSample>& left)
      : triangle_(triangle),
        tolerance_m_(tolerance_m),
        left_(left),
        meeting_(triangle.meeting_corners()) {
    double reach = 0, relief_m = tolerance_m;
    const FieldPoint& origin = triangle.from_[0];
    for (std::size_t k = 0; k < 3; ++k) {
      for (const FieldPoint* p : {&triangle.from_[k], &triangle.to_[k]}) {
        reach =
            std::max({reach, std::abs(p->column - origin.column), std::abs(p->row - origin.row)});
        relief_m = std::max(relief_m, std::abs(p->height_m - origin.height_m));
      }
      limits_.begin_m[k] = static_cast<float>(triangle.from_[k].height_m - origin.height_m);
      limits_.end_m[k] = static_cast<float>(triangle.to_[k].height_m - origin.height_m);
      for (std::size_t i = 0; i < 3; ++i) {
        constant_[k][i] = static_cast<float>(triangle.areas_[k][i].constant);
        per_column_[k][i] = static_cast<float>(triangle.areas_[k][i].per_column);
        per_row_[k][i] = static_cast<float>(triangle.areas_[k][i].per_row);
      }
    }
    const double area_doubt = kDoubt * (reach + margin_cells) * (reach + margin_cells);
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
    // samples may lie beside the triangle, by at most the slack on two sides
    const double beside_m = 2 * triangle.slack_ * (triangle.highest_m_ - triangle.lowest_m_);
    near_m_ = static_cast<float>(tolerance_m - beside_m - kDoubt * (relief_m + tolerance_m));
    least_near_m_ = static_cast<float>(triangle.highest_m_ - origin.height_m) - near_m_;
    most_near_m_ = static_cast<float>(triangle.lowest_m_ - origin.height_m) + near_m_;
    highest_m_ = static_cast<float>(2 * (relief_m + tolerance_m));
    const auto& [plane, farthest_m] = HalfwayPlane(triangle.from_, triangle.to_);
    halfway_m_ = static_cast<float>(plane.height_m(origin.column, origin.row) - origin.height_m);
    halfway_per_column_m_ = static_cast<float>(plane.per_column_m());
    halfway_per_row_m_ = static_cast<float>(plane.per_row_m());
    const double rise_m = std::abs(plane.per_column_m()) + std::abs(plane.per_row_m());
    halfway_room_m_ =
        static_cast<float>(tolerance_m - farthest_m * (1 + 4 * triangle.slack_) -
                           kDoubt * (relief_m + tolerance_m + rise_m * (reach + margin_cells)));
  }

  /// Part of a row of a field.
  bool operator()(const SampleField& field, const RowSpan& span) const {
    return field.is_reduced() ? in_row(span, field.behind.row(span.first, span.row))
                              : in_row(span, field.row(span.row) + span.first);
  }

  /// Part of a row in one block of slabs: are all heights that they let it have near?
  bool operator()(const HeightSlabs& slabs, const RowSpan& span) const {
    const std::int64_t side = slabs.side();
    const HeightSlab& slab = slabs.at(span.first / side, span.row / side);
    const double middle_m =
        slab.middle_m(static_cast<double>(span.first % side), static_cast<double>(span.row % side));
    return in_row(span, SlabRow{middle_m + slab.half_m, slab.per_column_m}) &&
           in_row(span, SlabRow{middle_m - slab.half_m, slab.per_column_m});
  }

  /// Is the triangle within the tolerance of all that the slab of a block can hold?
  /// \param right, down  blocks from the first one.
  bool is_clear_of(const HeightSlabs& slabs, std::int64_t right, std::int64_t down) const {
    const std::int64_t side = slabs.side();
    const HeightSlab& slab = slabs.at(right, down);
    if (slab.is_empty()) return true;
    const FieldPoint& origin = triangle_.from_[0];
    const SlabClearing clearing{*this, slab, static_cast<double>(side - 1),
                                static_cast<double>(right * side) - origin.column,
                                static_cast<double>(down * side) - origin.row};
    return has_wide_lanes() ? run_wide(clearing) : run_portable(clearing);
  }

  /// Any samples that have heights.
  bool operator()(std::span<const FieldSample> samples) const {
    return in_eights(KeptSamples{samples, triangle_.from_[0]});
  }

 private:
  /// What samples are held against over some part of the time.
  struct Limits {
    std::array<float, 4> room;            // more off than that may be over the tolerance
    std::array<float, 3> outside;         // an area less than that is surely outside
    std::array<float, 3> begin_m, end_m;  // heights of the corners

    TERRANE_LANES_INLINE Limits split_off_first() {
      Limits first;
      first.room = split(room);
      first.outside = split(outside);
      for (std::size_t k = 0; k < 3; ++k) {
        first.begin_m[k] = begin_m[k];
        first.end_m[k] = begin_m[k] = (begin_m[k] + end_m[k]) * 0.5F;
      }
      return first;
    }
  };

  /// Eight samples over some part of the time; polynomials in Bernstein form.
  struct Passages {
    Limits limits;
    std::array<std::array<Lanes, 3>, 3> inside;
    std::array<Lanes, 4> off;
    LaneMask near_begin, near_end;  // of the samples that are near all corners at an end
    LaneMask known;                 // of those that need no look
    int splits;                     // that may still be made

    TERRANE_LANES_INLINE Passages split_off_first(const Lanes& height_m, float near_m) {
      Passages first;
      first.limits = limits.split_off_first();
      for (std::size_t k = 0; k < 3; ++k) first.inside[k] = split(inside[k]);
      first.off = split(off);
      first.near_begin = near_begin;
      first.near_end = near_begin = are_near(height_m, limits.begin_m, near_m);
      first.known = known;
      first.splits = --splits;
      return first;
    }
    /// What lies between corners that are near is so, too.
    TERRANE_LANES_INLINE LaneMask are_near_corners() const { return near_begin & near_end; }
    TERRANE_LANES_INLINE LaneMask are_outside_of(std::size_t k) const {
      return (inside[k][0] < limits.outside[0]) & (inside[k][1] < limits.outside[1]) &
             (inside[k][2] < limits.outside[2]);
    }
    TERRANE_LANES_INLINE LaneMask are_outside() const {
      return are_outside_of(0) | are_outside_of(1) | are_outside_of(2);
    }
    /// Are all eight on the outer side of one edge?
    TERRANE_LANES_INLINE bool are_beside() const {
      return !any(~are_outside_of(0)) || !any(~are_outside_of(1)) || !any(~are_outside_of(2));
    }
    TERRANE_LANES_INLINE LaneMask have_room() const {
      return (abs(off[0]) <= limits.room[0]) & (abs(off[1]) <= limits.room[1]) &
             (abs(off[2]) <= limits.room[2]) & (abs(off[3]) <= limits.room[3]);
    }
  };

  /// Eight samples, counted from a corner.
  struct Eight {
    Lanes x, y, height_m;
  };

  /// Samples of a row.
  template <class Heights>
  struct RowSamples {
    Heights all_heights_m;
    double first_column, row;
    const FieldPoint& origin;
    std::size_t count;

    FieldSample operator[](std::size_t k) const {
      return {static_cast<float>(first_column + static_cast<double>(k)), static_cast<float>(row),
              all_heights_m[k]};
    }
    TERRANE_LANES_INLINE Lanes heights_m(std::size_t first) const {
      if (first + kLanes <= count) return lanes_of(all_heights_m, first, origin.height_m);
      Lanes result{};
      for (std::size_t k = 0; k < kLanes; ++k) {
        const std::size_t at = std::min(first + k, count - 1);
        result[k] = static_cast<float>(all_heights_m[at] - origin.height_m);
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
        const Eight eight = samples.eight(first, samples.heights_m(first));
        const Lanes& height_m = eight.height_m;
        // samples without data are as good as cleared
        const LaneMask is_known = (height_m != height_m) | sweep.are_cleared_at_a_look(eight);
        if (!any(~is_known)) continue;
        const LaneMask too_far = ~(is_known | (abs(height_m) <= sweep.highest_m_));
        const auto undecided = [](const Passages& passages) __attribute__((always_inline)) {
          return ~(passages.are_near_corners() | passages.have_room() | passages.are_outside());
        };
        const LaneMask in_doubt =
            too_far | sweep.in_doubt<kSplitsAtOnce>(eight, is_known | too_far, undecided);
        if (any(in_doubt)) return {first, bits_of(in_doubt)};
      }
      return {samples.count, 0};
    }
  };

  /// Heights off and areas are affine over the grid and in height: what all corners of a slab have
  /// room for, or lie beside, all between them has or does.
  struct SlabClearing {
    const Sweep& sweep;
    const HeightSlab& slab;
    double far;   // to its last sample along a row
    double x, y;  // of its first sample, from the triangle's first corner

    TERRANE_LANES_INLINE bool run() const {
      const Eight corners = eight();
      if (!any(~sweep.are_near_halfway_plane(corners))) return true;
      if (any(~(abs(corners.height_m) <= sweep.highest_m_))) return false;
      const auto undecided = [](const Passages& passages) __attribute__((always_inline)) {
        const bool is_clear = !any(~passages.are_near_corners()) || !any(~passages.have_room()) ||
                              passages.are_beside();
        return is_clear ? LaneMask{} : ~LaneMask{};
      };
      return !any(sweep.in_doubt<kSplitsOfSlab>(corners, LaneMask{}, undecided));
    }

    TERRANE_LANES_INLINE Eight eight() const {
      const double origin_m = sweep.triangle_.from_[0].height_m;
      Eight corners{};
      for (std::size_t k = 0; k < kLanes; ++k) {
        const double right = (k & 1) == 0 ? 0 : far, down = (k & 2) == 0 ? 0 : far;
        const double above_m = (k & 4) == 0 ? slab.half_m : -slab.half_m;
        corners.x[k] = static_cast<float>(x + right);
        corners.y[k] = static_cast<float>(y + down);
        corners.height_m[k] = static_cast<float>(slab.middle_m(right, down) + above_m - origin_m);
      }
      return corners;
    }
  };

  template <class Heights>
  bool in_row(const RowSpan& span, const Heights& heights_m) const {
    return in_eights(RowSamples{heights_m, static_cast<double>(span.first),
                                static_cast<double>(span.row), triangle_.from_[0],
                                static_cast<std::size_t>(span.last - span.first + 1)});
  }

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
          left_ = sample;
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

  TERRANE_LANES_INLINE LaneMask are_near_halfway_plane(const Eight& eight) const {
    const Lanes plane_m =
        halfway_m_ + eight.y * halfway_per_row_m_ + eight.x * halfway_per_column_m_;
    return abs(eight.height_m - plane_m) <= halfway_room_m_;
  }

  TERRANE_LANES_INLINE LaneMask are_cleared_at_a_look(const Eight& eight) const {
    return are_near_halfway_plane(eight) |
           ((eight.height_m >= least_near_m_) & (eight.height_m <= most_near_m_));
  }

  TERRANE_LANES_INLINE static LaneMask are_near(const Lanes& height_m,
                                                const std::array<float, 3>& corners_m,
                                                float near_m) {
    return (abs(height_m - corners_m[0]) <= near_m) & (abs(height_m - corners_m[1]) <= near_m) &
           (abs(height_m - corners_m[2]) <= near_m);
  }

  TERRANE_LANES_INLINE void begin(const Eight& eight, Passages& all) const {
    all.limits = limits_;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 3; ++i) {
        all.inside[k][i] = constant_[k][i] + eight.y * per_row_[k][i] + eight.x * per_column_[k][i];
      }
    }
    for (Lanes& off : all.off) off = Lanes{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::array<Lanes, 3>& area = all.inside[k];
      const Lanes first = limits_.begin_m[k] - eight.height_m;
      const Lanes last = limits_.end_m[k] - eight.height_m;
      constexpr float kThird = 1.0F / 3;
      all.off[0] += area[0] * first;
      all.off[1] += (area[0] * last + 2.0F * area[1] * first) * kThird;
      all.off[2] += (2.0F * area[1] * last + area[2] * first) * kThird;
      all.off[3] += area[2] * last;
    }
    for (std::size_t i = 4 - vanishing(); i < 4; ++i) all.off[i] = Lanes{};
    all.near_begin = are_near(eight.height_m, limits_.begin_m, near_m_);
    all.near_end = are_near(eight.height_m, limits_.end_m, near_m_);
  }

  /// Splits the time in halves, and those again, for the samples that are undecided in some part.
  /// \param known      samples that need no look.
  /// \param undecided  called with the passages of some part; tells which samples are not decided.
  /// \return those that never are.
  template <int kSplits, class Undecided>
  TERRANE_LANES_INLINE LaneMask in_doubt(const Eight& eight, const LaneMask& known,
                                         const Undecided& undecided) const {
    std::array<Passages, kSplits + 1> parts;  // the last one comes first
    begin(eight, parts[0]);
    parts[0].known = known;
    parts[0].splits = kSplits;
    LaneMask in_doubt{};
    for (std::size_t count = 1; count > 0;) {
      Passages& part = parts[count - 1];
      const LaneMask open = undecided(part) & ~(part.known | in_doubt);
      if (!any(open)) {
        --count;
      } else if (part.splits == 0) {
        in_doubt |= open;
        --count;
      } else {
        part.known = ~open;
        parts[count++] = part.split_off_first(eight.height_m, near_m_);
      }
    }
    return in_doubt;
  }

  const MovingTriangle& triangle_;
  double tolerance_m_;
  std::optional<FieldSample>& left_;
  int meeting_;
  float constant_[3][3], per_column_[3][3], per_row_[3][3];
  Limits limits_;
  float highest_m_;
  float near_m_;                      // what is so near to a corner is surely within the tolerance
  float least_near_m_, most_near_m_;  // heights that are so near to all corners
  // HalfwayPlane from the first corner on, and how far from it is surely near enough
  float halfway_m_, halfway_per_column_m_, halfway_per_row_m_, halfway_room_m_;
};

/// All samples under some hull; where there are slabs, those that they do not clear.
std::optional<FieldSample> MovingTriangle::find_left_of_all(std::span<const FieldPoint> hull,
                                                            const SampleField& field,
                                                            double tolerance_m) const {
  const GridShape shape{field.columns, field.rows};
  const HeightSlabs& slabs = field.slabs;
  const double beside_cells = slabs.empty() ? 0 : static_cast<double>(slabs.side());
  std::optional<FieldSample> left;
  const Sweep sweep(*this, tolerance_m, kMargin + beside_cells, left);
  if (slabs.empty()) {
    for_each_span_of_hull(hull, shape, field.slack_cells,
                          [&](std::int64_t row, std::int64_t first, std::int64_t last) {
                            return sweep(field, {row, first, last});
                          });
    return left;
  }
  for_each_part_not_clear(
      HullSides(hull).sides(), shape, field.slack_cells, slabs,
      [&](std::int64_t column, std::int64_t row) { return sweep.is_clear_of(slabs, column, row); },
      [&](const RowSpan& part) {
        return field.has_grid() ? sweep(field, part) : sweep(slabs, part);
      });
  return left;
}

std::optional<FieldSample> MovingTriangle::find_left(const SampleField& field,
                                                     double tolerance_m) const {
  // a point under the triangle is at any time between two that are under it at the ends
  std::array<FieldPoint, 6> corners{from_[0], from_[1], from_[2]};
  std::size_t count = 3;
  for (std::size_t k = 0; k < 3; ++k) {
    if (from_[k] != to_[k]) corners[count++] = to_[k];
  }
  if (count == 3) return std::nullopt;
  const std::span<const FieldPoint> hull = std::span(corners).first(count);
  if (!field.is_reduced()) return find_left_of_all(hull, field, tolerance_m);
  if (!field.behind.empty()) {
    return find_left_of_all(hull, field, tolerance_m - field.behind.rounding_m());
  }
  if (field.is_backed()) return find_left_of_all(hull, field, tolerance_m);
  std::optional<FieldSample> left;
  for_each_kept_run_of_hull(hull, field, field.slack_cells,
                            Sweep(*this, tolerance_m, kMargin, left));
  return left;
}

}  // namespace terrane::hierarchy

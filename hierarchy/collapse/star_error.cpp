#include "hierarchy/collapse/star_error.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hierarchy/collapse/coded_lanes.h"
#include "hierarchy/collapse/field_plane.h"
#include "hierarchy/collapse/lanes.h"
#include "hierarchy/collapse/slab_parts.h"

namespace terrane::hierarchy {
namespace {

FieldPoint field_point(const Place& place) {
  return {column_of(place.plan), row_of(place.plan), place.height_m};
}

/// Part of a row of samples under a triangle.
struct RowPart {
  CodedHeights::Row heights_m;
  std::int64_t count;
  double first_m, per_column_m;  // of the triangle

  /// The largest distance; samples without data have none.
  TERRANE_LANES_INLINE double run() const {
    constexpr std::int64_t kAtOnce = kLanes;
    std::array<HalfLanes, 2> most_m{}, at{HalfLanes{0, 1, 2, 3}, HalfLanes{4, 5, 6, 7}};
    std::int64_t k = 0;
    for (; k + kAtOnce <= count; k += kAtOnce) {
      const auto eight_m = lanes_of(heights_m, static_cast<std::size_t>(k));
      for (std::size_t half = 0; half < 2; ++half) {
        const HalfLanes above_m = first_m + at[half] * per_column_m - eight_m[half];
        const HalfLanes off_m = above_m < 0 ? -above_m : above_m;
        most_m[half] = off_m > most_m[half] ? off_m : most_m[half];
        at[half] += static_cast<double>(kAtOnce);
      }
    }
    double result = 0;
    for (const HalfLanes& of_half : most_m) {
      for (std::size_t i = 0; i < kLanes / 2; ++i) result = std::max(result, of_half[i]);
    }
    for (; k < count; ++k) {
      const double off_m = std::abs(first_m + static_cast<double>(k) * per_column_m -
                                    heights_m[static_cast<std::size_t>(k)]);
      result = off_m > result ? off_m : result;
    }
    return result;
  }

  /// The first sample that is so far off.
  std::int64_t find(double off_m) const {
    for (std::int64_t k = 0; k < count; ++k) {
      if (std::abs(first_m + static_cast<double>(k) * per_column_m -
                   heights_m[static_cast<std::size_t>(k)]) == off_m) {
        return k;
      }
    }
    return 0;
  }
};

/// A triangle of a star.
class Sector {
 public:
  /// \param slack_cells  samples so far beside it count as under it.
  Sector(const Place& a, const Place& b, const Place& c, double slack_cells)
      : corners_{field_point(a), field_point(b), field_point(c)},
        plane_(corners_[0], corners_[1], corners_[2]) {
    const auto [lowest, highest] = std::ranges::minmax(corners_, {}, &FieldPoint::height_m);
    const double beside_m =
        slack_cells * (std::abs(plane_.per_column_m()) + std::abs(plane_.per_row_m()));
    lowest_m_ = lowest.height_m - beside_m;
    highest_m_ = highest.height_m + beside_m;
  }

  const FieldPlane& plane() const { return plane_; }
  double lowest_m() const { return lowest_m_; }
  double highest_m() const { return highest_m_; }
  std::array<FieldSide, 3> sides() const {
    const auto& [a, b, c] = corners_;
    return {FieldSide{&a, &b}, {&b, &c}, {&c, &a}};
  }

 private:
  std::array<FieldPoint, 3> corners_;
  FieldPlane plane_;
  double lowest_m_, highest_m_;
};

void raise_by_row(const Sector& sector, const CodedHeights& heights, const RowSpan& span,
                  StarError& error) {
  const RowPart part{
      heights.row(span.first, span.row), span.last - span.first + 1,
      sector.plane().height_m(static_cast<double>(span.first), static_cast<double>(span.row)),
      sector.plane().per_column_m()};
  const double most_m = has_wide_lanes() ? run_wide(part) : run_portable(part);
  if (most_m <= error.most_m) return;
  const std::int64_t column = span.first + part.find(most_m);
  error = {
      most_m,
      {static_cast<float>(column), static_cast<float>(span.row), heights.row(column, span.row)[0]}};
}

void raise_by_rows(const Sector& sector, const SampleField& field, StarError& error) {
  for_each_span_between(sector.sides(), {field.columns, field.rows}, field.slack_cells,
                        [&](std::int64_t row, std::int64_t first, std::int64_t last) {
                          raise_by_row(sector, field.behind, {row, first, last}, error);
                          return true;
                        });
}

/// The farthest that the triangle can be from a sample of a block: its plane, or if that is less
/// its corners.
double most_of_block_m(const Sector& sector, const HeightSlabs& slabs, std::int64_t column,
                       std::int64_t row) {
  const std::int64_t side = slabs.side(), left = column * side, top = row * side;
  const HeightSlab& slab = slabs.at(column, row);
  if (slab.is_empty()) return 0;
  double most_m = 0, lowest_m = INFINITY, highest_m = -INFINITY;
  for (const std::int64_t right : {std::int64_t{0}, side - 1}) {
    for (const std::int64_t down : {std::int64_t{0}, side - 1}) {
      const auto r = static_cast<double>(right), d = static_cast<double>(down);
      const double middle_m = slab.middle_m(r, d);
      const double on_sector_m =
          sector.plane().height_m(static_cast<double>(left) + r, static_cast<double>(top) + d);
      most_m = std::max(most_m, std::abs(on_sector_m - middle_m));
      lowest_m = std::min(lowest_m, middle_m);
      highest_m = std::max(highest_m, middle_m);
    }
  }
  const double between_corners_m =
      std::max(sector.highest_m() - lowest_m, highest_m - sector.lowest_m());
  return std::min(most_m, between_corners_m) + slab.half_m;
}

/// The same where all that is known of the samples is the slab they are in: in a row, what is
/// farthest is at an end.
void raise_by_slab(const Sector& sector, const HeightSlabs& slabs, const RowSpan& span,
                   StarError& error) {
  const std::int64_t side = slabs.side();
  const HeightSlab& slab = slabs.at(span.first / side, span.row / side);
  if (slab.is_empty()) return;
  for (const std::int64_t column : {span.first, span.last}) {
    const auto c = static_cast<double>(column), r = static_cast<double>(span.row);
    const double middle_m =
        slab.middle_m(static_cast<double>(column % side), static_cast<double>(span.row % side));
    const double above_m = sector.plane().height_m(c, r) - middle_m;
    const double most_m = std::abs(above_m) + slab.half_m;
    if (most_m <= error.most_m) continue;
    error = {most_m,
             {static_cast<float>(column), static_cast<float>(span.row),
              middle_m - std::copysign(double{slab.half_m}, above_m)}};
  }
}

/// By blocks of samples, less those that are surely within the tolerance.
void raise_by_blocks(const Sector& sector, const SampleField& field, double tolerance_m,
                     StarError& error) {
  for_each_part_not_clear(
      sector.sides(), {field.columns, field.rows}, field.slack_cells, field.slabs,
      [&](std::int64_t column, std::int64_t row) {
        return most_of_block_m(sector, field.slabs, column, row) <=
               std::max(tolerance_m, error.most_m);
      },
      [&](const RowSpan& part) {
        if (field.behind.empty()) {
          raise_by_slab(sector, field.slabs, part, error);
        } else {
          raise_by_row(sector, field.behind, part, error);
        }
        return true;
      });
}

}  // namespace

StarError error_of_star(const Star& star, const Place& centre, const SampleField& field,
                        double tolerance_m) {
  StarError error;
  const double rounding_m = field.behind.empty() ? 0 : field.behind.rounding_m();
  for (std::size_t s = 0; s < star.sector_count(); ++s) {
    const Sector sector(centre, star.corner(s), star.corner(s + 1), field.slack_cells);
    if (field.slabs.empty()) {
      raise_by_rows(sector, field, error);
    } else {
      raise_by_blocks(sector, field, tolerance_m - rounding_m, error);
    }
  }
  error.most_m += rounding_m;
  return error;
}

}  // namespace terrane::hierarchy

#include "hierarchy/collapse/star_error.h"

#include <cmath>

#include "hierarchy/collapse/field_plane.h"
#include "hierarchy/collapse/lanes.h"
#include "hierarchy/collapse/slab_rows.h"

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
    constexpr std::int64_t kAtOnce = 8;
    double most_m[kAtOnce] = {};
    std::int64_t k = 0;
    for (; k + kAtOnce <= count; k += kAtOnce) {
      for (std::int64_t i = 0; i < kAtOnce; ++i) {
        const double off_m = std::abs(first_m + static_cast<double>(k + i) * per_column_m -
                                      heights_m[static_cast<std::size_t>(k + i)]);
        most_m[i] = off_m > most_m[i] ? off_m : most_m[i];
      }
    }
    for (std::int64_t i = 0; k < count; ++k, ++i) {
      const double off_m = std::abs(first_m + static_cast<double>(k) * per_column_m -
                                    heights_m[static_cast<std::size_t>(k)]);
      most_m[i] = off_m > most_m[i] ? off_m : most_m[i];
    }
    double result = 0;
    for (const double off_m : most_m) result = off_m > result ? off_m : result;
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
  Sector(const Place& a, const Place& b, const Place& c)
      : a_(field_point(a)), b_(field_point(b)), c_(field_point(c)), plane_(a_, b_, c_) {}

  const FieldPlane& plane() const { return plane_; }
  template <class Visit>
  void for_each_span_of(const SampleField& field, const Visit& visit) const {
    for_each_span(a_, b_, c_, {field.columns, field.rows}, field.slack_cells, visit);
  }

 private:
  FieldPoint a_, b_, c_;
  FieldPlane plane_;
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
  sector.for_each_span_of(field, [&](std::int64_t row, std::int64_t first, std::int64_t last) {
    raise_by_row(sector, field.behind, {row, first, last}, error);
    return true;
  });
}

/// The farthest that the triangle's plane can be from a sample of the block that some sample is in.
double most_of_block_m(const Sector& sector, const HeightSlabs& slabs, std::int64_t column,
                       std::int64_t row) {
  const std::int64_t side = slabs.side(), left = column / side * side, top = row / side * side;
  const HeightSlab& slab = slabs.at(column / side, row / side);
  if (slab.is_empty()) return 0;
  double most_m = 0;
  for (const std::int64_t right : {std::int64_t{0}, side - 1}) {
    for (const std::int64_t down : {std::int64_t{0}, side - 1}) {
      const auto r = static_cast<double>(right), d = static_cast<double>(down);
      const double on_sector_m =
          sector.plane().height_m(static_cast<double>(left) + r, static_cast<double>(top) + d);
      most_m = std::max(most_m, std::abs(on_sector_m - slab.middle_m(r, d)));
    }
  }
  return most_m + slab.half_m;
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
  const std::int64_t side = field.slabs.side();
  const auto over_blocks = [&](std::span<const RowSpan> spans) {
    return for_each_block_of(spans, side, [&](std::int64_t first, std::int64_t last) {
      const double enough_m = std::max(tolerance_m, error.most_m);
      if (most_of_block_m(sector, field.slabs, first, spans[0].row) <= enough_m) return true;
      return for_each_part_of(spans, first, last, [&](const RowSpan& part) {
        if (field.behind.empty()) {
          raise_by_slab(sector, field.slabs, part, error);
        } else {
          raise_by_row(sector, field.behind, part, error);
        }
        return true;
      });
    });
  };
  SlabRows rows(side, over_blocks);
  sector.for_each_span_of(field, [&](std::int64_t row, std::int64_t first, std::int64_t last) {
    return rows.add(row, first, last);
  });
  rows.end();
}

}  // namespace

StarError error_of_star(const Star& star, const Place& centre, const SampleField& field,
                        double tolerance_m) {
  StarError error;
  const double rounding_m = field.behind.empty() ? 0 : field.behind.rounding_m();
  for (std::size_t s = 0; s < star.sector_count(); ++s) {
    const Sector sector(centre, star.corner(s), star.corner(s + 1));
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

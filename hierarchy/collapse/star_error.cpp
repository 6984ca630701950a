#include "hierarchy/collapse/star_error.h"

#include <cmath>

#include "hierarchy/collapse/lanes.h"

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

}  // namespace

double worst_under_star(const Star& star, const Place& centre, const SampleField& field,
                        CoveredSample& worst) {
  const bool is_wide = has_wide_lanes();
  const FieldPoint a = field_point(centre);
  double worst_m = 0;
  for (std::size_t s = 0; s < star.sector_count(); ++s) {
    const FieldPoint b = field_point(star.corner(s)), c = field_point(star.corner(s + 1));
    const double bx = b.column - a.column, by = b.row - a.row, bz = b.height_m - a.height_m;
    const double cx = c.column - a.column, cy = c.row - a.row, cz = c.height_m - a.height_m;
    const double area = bx * cy - by * cx;
    const double per_column_m = (bz * cy - cz * by) / area;
    const double per_row_m = (bx * cz - cx * bz) / area;
    for_each_span(
        a, b, c, {field.columns, field.rows}, field.slack_cells,
        [&](std::int64_t row, std::int64_t first, std::int64_t last) {
          const double first_m = a.height_m +
                                 (static_cast<double>(first) - a.column) * per_column_m +
                                 (static_cast<double>(row) - a.row) * per_row_m;
          const RowPart part{field.behind.row(first, row), last - first + 1, first_m, per_column_m};
          const double most_m = is_wide ? run_wide(part) : run_portable(part);
          if (most_m <= worst_m) return true;
          worst_m = most_m;
          const std::int64_t column = first + part.find(most_m);
          worst = {static_cast<float>(column), static_cast<float>(row),
                   field.behind.row(column, row)[0]};
          return true;
        });
  }
  return worst_m + field.behind.rounding_m();
}

}  // namespace terrane::hierarchy

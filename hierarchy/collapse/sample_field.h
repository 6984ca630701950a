#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "hierarchy/mesh/grid_point.h"

namespace terrane::hierarchy {

/// What a mesh is measured against: a height for each sample of a tile, in metres over a datum that
/// curves with the Earth (so that a flat triangle is linear in it); NaN where there is none.
struct SampleField {
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  std::vector<double> heights_m;  ///< row by row
  /// Samples this near to a triangle, in cells, count as under it: by rounding, one on the outline
  /// may lie just outside. At least a little, as a sample on an edge is better met twice than
  /// never.
  double slack_cells = 1e-7;

  const double* row(std::int64_t r) const {
    return heights_m.data() + static_cast<std::ptrdiff_t>(r * columns);
  }
};

/// A corner of a triangle over a SampleField, in cells.
struct FieldPoint {
  double column = 0;
  double row = 0;
  double height_m = 0;
};

/// Calls visit(row, first_column, last_column) for each row of samples under the triangle or nearer
/// to it than \p slack_cells, in columns and rows. Stops and returns false as soon as visit does.
template <class Visit>
bool for_each_span(const FieldPoint& a, const FieldPoint& b, const FieldPoint& c,
                   const SampleField& field, double slack_cells, Visit&& visit) {
  const double top = std::min({a.row, b.row, c.row}) - slack_cells;
  const double bottom = std::max({a.row, b.row, c.row}) + slack_cells;
  const auto first_row = std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil(top)));
  const auto last_row =
      std::min<std::int64_t>(field.rows - 1, static_cast<std::int64_t>(std::floor(bottom)));
  const std::pair<const FieldPoint*, const FieldPoint*> sides[3] = {{&a, &b}, {&b, &c}, {&c, &a}};

  for (std::int64_t row = first_row; row <= last_row; ++row) {
    const double above = static_cast<double>(row) - slack_cells;
    const double below = static_cast<double>(row) + slack_cells;
    double left = std::numeric_limits<double>::infinity();
    double right = -left;
    for (const auto& [p, q] : sides) {
      // the part of the side between the lines above and below the row
      const auto [upper, lower] = p->row < q->row ? std::pair{p, q} : std::pair{q, p};
      if (lower->row < above || upper->row > below) continue;
      const double per_row =
          lower->row > upper->row ? (lower->column - upper->column) / (lower->row - upper->row) : 0;
      const double at_top =
          above <= upper->row ? upper->column : upper->column + (above - upper->row) * per_row;
      const double at_bottom =
          below >= lower->row ? lower->column : upper->column + (below - upper->row) * per_row;
      left = std::min({left, at_top, at_bottom});
      right = std::max({right, at_top, at_bottom});
    }
    const auto first =
        std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil(left - slack_cells)));
    const auto last = std::min<std::int64_t>(
        field.columns - 1, static_cast<std::int64_t>(std::floor(right + slack_cells)));
    if (first <= last && !visit(row, first, last)) return false;
  }
  return true;
}

}  // namespace terrane::hierarchy

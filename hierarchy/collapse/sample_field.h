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

/// Calls visit(row, first_column, last_column) for each row of samples under the triangle, border
/// included. Stops and returns false as soon as visit does.
template <class Visit>
bool for_each_span(const FieldPoint& a, const FieldPoint& b, const FieldPoint& c,
                   const SampleField& field, Visit&& visit) {
  // samples on an edge belong to both triangles: better twice than never
  constexpr double kSlackCells = 1e-7;
  const double top = std::min({a.row, b.row, c.row}) - kSlackCells;
  const double bottom = std::max({a.row, b.row, c.row}) + kSlackCells;
  const auto first_row = std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil(top)));
  const auto last_row =
      std::min<std::int64_t>(field.rows - 1, static_cast<std::int64_t>(std::floor(bottom)));
  const std::pair<const FieldPoint*, const FieldPoint*> sides[3] = {{&a, &b}, {&b, &c}, {&c, &a}};

  for (std::int64_t row = first_row; row <= last_row; ++row) {
    const auto y = static_cast<double>(row);
    double left = std::numeric_limits<double>::infinity();
    double right = -left;
    for (const auto& [p, q] : sides) {
      if (y < std::min(p->row, q->row) - kSlackCells) continue;
      if (y > std::max(p->row, q->row) + kSlackCells) continue;
      const double rise = q->row - p->row;
      if (std::abs(rise) <= 2 * kSlackCells) {
        left = std::min({left, p->column, q->column});
        right = std::max({right, p->column, q->column});
        continue;
      }
      const double t = std::clamp((y - p->row) / rise, 0.0, 1.0);
      const double x = p->column + t * (q->column - p->column);
      left = std::min(left, x);
      right = std::max(right, x);
    }
    const auto first = std::max<std::int64_t>(
        0, static_cast<std::int64_t>(std::ceil(left - kSlackCells)));
    const auto last = std::min<std::int64_t>(
        field.columns - 1, static_cast<std::int64_t>(std::floor(right + kSlackCells)));
    if (first <= last && !visit(row, first, last)) return false;
  }
  return true;
}

}  // namespace terrane::hierarchy

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "core/height_grid.h"

// The samples of a grid that lie in a triangle or in the convex hull of a few points.

namespace terrane::hierarchy {

/// A corner of a triangle over a grid of samples, in cells.
struct FieldPoint {
  double column = 0;
  double row = 0;
  double height_m = 0;

  bool operator==(const FieldPoint&) const = default;
};

/// A straight line between two points.
using FieldSide = std::pair<const FieldPoint*, const FieldPoint*>;

/// A side from top to bottom, so that rows find its columns without a division.
struct FallingSide {
  double top, bottom, top_column, bottom_column, per_row;

  explicit FallingSide(const FieldSide& side) {
    const auto [upper, lower] = side.first->row < side.second->row
                                    ? std::pair{side.first, side.second}
                                    : std::pair{side.second, side.first};
    top = upper->row;
    bottom = lower->row;
    top_column = upper->column;
    bottom_column = lower->column;
    per_row = bottom > top ? (bottom_column - top_column) / (bottom - top) : 0;
  }
  FallingSide() = default;

  /// \param cells  along a block: from now on, it is counted in those, from the middle of the
  /// first.
  void count_in(double cells) {
    for (double* at : {&top, &bottom, &top_column, &bottom_column}) {
      *at = (*at - (cells - 1) / 2) / cells;
    }
  }
};

/// The most sides that SpansBetween takes: those of a hull of six points.
inline constexpr std::size_t kMostSides = 6;

/// Columns of a row of samples.
struct RowSpan {
  std::int64_t row, first, last;

  bool is_empty() const { return first > last; }
};

/// The samples between the leftmost and the rightmost of some sides that go all around, row by row.
class SpansBetween {
 public:
  /// \param slack_cells  samples this near to the sides, in columns and rows, count as well.
  /// \param cells        whatever lies between them is counted in blocks of this many cells, from
  ///                     the middle of the first block; so are the shape and the slack.
  SpansBetween(std::span<const FieldSide> sides, const GridShape& shape, double slack_cells,
               std::int64_t cells = 1)
      : columns_(shape.columns), slack_cells_(slack_cells), count_(sides.size()) {
    double top = std::numeric_limits<double>::infinity(), bottom = -top;
    for (std::size_t k = 0; k < count_; ++k) {
      falling_[k] = FallingSide(sides[k]);
      if (cells > 1) falling_[k].count_in(static_cast<double>(cells));
      top = std::min(top, falling_[k].top);
      bottom = std::max(bottom, falling_[k].bottom);
    }
    first_row_ = std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil(top - slack_cells)));
    last_row_ = std::min<std::int64_t>(shape.rows - 1,
                                       static_cast<std::int64_t>(std::floor(bottom + slack_cells)));
  }

  std::int64_t first_row() const { return first_row_; }
  std::int64_t last_row() const { return last_row_; }

  RowSpan of_row(std::int64_t row) const {
    const double above = static_cast<double>(row) - slack_cells_;
    const double below = static_cast<double>(row) + slack_cells_;
    double left = std::numeric_limits<double>::infinity();
    double right = -left;
    for (const FallingSide& side : std::span(falling_).first(count_)) {
      // the part of the side between the lines above and below the row
      if (side.bottom < above || side.top > below) continue;
      const double at_top =
          above <= side.top ? side.top_column : side.top_column + (above - side.top) * side.per_row;
      const double at_bottom = below >= side.bottom
                                   ? side.bottom_column
                                   : side.top_column + (below - side.top) * side.per_row;
      left = std::min({left, at_top, at_bottom});
      right = std::max({right, at_top, at_bottom});
    }
    if (left > right) return {row, 0, -1};
    return {row,
            std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil(left - slack_cells_))),
            std::min<std::int64_t>(columns_ - 1,
                                   static_cast<std::int64_t>(std::floor(right + slack_cells_)))};
  }

 private:
  std::array<FallingSide, kMostSides> falling_;
  std::int64_t columns_, first_row_, last_row_;
  double slack_cells_;
  std::size_t count_;
};

/// Calls visit(row, first_column, last_column) for each row that has samples. Stops and returns
/// false as soon as visit does.
template <class Visit>
bool for_each_span_of(const SpansBetween& spans, Visit&& visit) {
  for (std::int64_t row = spans.first_row(); row <= spans.last_row(); ++row) {
    const RowSpan span = spans.of_row(row);
    if (!span.is_empty() && !visit(row, span.first, span.last)) return false;
  }
  return true;
}

/// The same for the samples between sides.
template <class Visit>
bool for_each_span_between(std::span<const FieldSide> sides, const GridShape& shape,
                           double slack_cells, Visit&& visit) {
  return for_each_span_of(SpansBetween(sides, shape, slack_cells), visit);
}

/// The same for those under a triangle.
template <class Visit>
bool for_each_span(const FieldPoint& a, const FieldPoint& b, const FieldPoint& c,
                   const GridShape& shape, double slack_cells, Visit&& visit) {
  const FieldSide sides[] = {{&a, &b}, {&b, &c}, {&c, &a}};
  return for_each_span_between(sides, shape, slack_cells, visit);
}

/// The sides of the convex hull of 3 to 6 points.
class HullSides {
 public:
  explicit HullSides(std::span<const FieldPoint> points) {
    std::array<const FieldPoint*, kMostSides> memory{};
    const auto sorted = std::span(memory).first(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
      const auto end = sorted.begin() + static_cast<std::ptrdiff_t>(k);
      *end = &points[k];
      std::rotate(std::upper_bound(sorted.begin(), end, *end, is_left_of), end, end + 1);
    }
    add_half(sorted);
    std::ranges::reverse(sorted);
    add_half(sorted);
  }
  std::span<const FieldSide> sides() const { return std::span(sides_).first(count_); }

 private:
  /// From the first point to the last on one side of all others (Andrew's monotone chain).
  void add_half(std::span<const FieldPoint* const> sorted) {
    const std::size_t first = count_;
    const FieldPoint* from = sorted[0];
    for (const FieldPoint* to : sorted.subspan(1)) {
      while (count_ > first && !turns_left(sides_[count_ - 1], *to)) from = sides_[--count_].first;
      sides_[count_++] = {from, to};
      from = to;
    }
  }
  static bool is_left_of(const FieldPoint* a, const FieldPoint* b) {
    return a->column < b->column || (a->column == b->column && a->row < b->row);
  }
  static bool turns_left(const FieldSide& side, const FieldPoint& to) {
    const auto& [p, q] = side;
    return (q->column - p->column) * (to.row - p->row) -
               (q->row - p->row) * (to.column - p->column) >
           0;
  }

  std::array<FieldSide, kMostSides> sides_;
  std::size_t count_ = 0;
};

/// The same for those in the convex hull of 3 to 6 points.
template <class Visit>
bool for_each_span_of_hull(std::span<const FieldPoint> points, const GridShape& shape,
                           double slack_cells, Visit&& visit) {
  return for_each_span_between(HullSides(points).sides(), shape, slack_cells, visit);
}

}  // namespace terrane::hierarchy

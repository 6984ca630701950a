#include "tiler/tile/inner_columns.h"

#include <algorithm>
#include <cmath>

namespace terrane::tiler {

using hierarchy::FieldPoint;

namespace {

double doubled_area(const FieldPoint& a, const FieldPoint& b, const FieldPoint& c) {
  return (b.row - a.row) * (c.column - a.column) - (b.column - a.column) * (c.row - a.row);
}

}  // namespace

InnerColumns::InnerColumns(const FieldPoint& a, const FieldPoint& b, const FieldPoint& c,
                           double margin_cells) {
  const FieldPoint* corners[] = {&a, &b, &c, &a};
  const double turn = doubled_area(a, b, c) > 0 ? 1 : -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const FieldPoint &p = *corners[k], &q = *corners[k + 1];
    const double along = turn * (q.column - p.column), down = turn * (q.row - p.row);
    // inside: down * (column - p.column) - along * (row - p.row) >= margin
    const double margin = margin_cells * std::hypot(along, down);
    if (down != 0) {
      const Side side{p.column + (margin - along * p.row) / down, along / down};
      (down > 0 ? left_[lefts_++] : right_[rights_++]) = side;
    } else if (along > 0) {
      bottom_ = std::min(bottom_, p.row - margin_cells);
    } else {
      top_ = std::max(top_, p.row + margin_cells);
    }
  }
}

std::pair<std::int64_t, std::int64_t> InnerColumns::of_row(std::int64_t row, std::int64_t first,
                                                           std::int64_t last) const {
  const auto at = static_cast<double>(row);
  if (at < top_ || at > bottom_) return {last + 1, last};
  auto left = static_cast<double>(first), right = static_cast<double>(last);
  for (std::size_t k = 0; k < lefts_; ++k) left = std::max(left, left_[k].column(at));
  for (std::size_t k = 0; k < rights_; ++k) right = std::min(right, right_[k].column(at));
  if (!(left <= right)) return {last + 1, last};
  return {static_cast<std::int64_t>(std::ceil(left)), static_cast<std::int64_t>(std::floor(right))};
}

}  // namespace terrane::tiler

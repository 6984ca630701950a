#include "hierarchy/collapse/height_slabs.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace terrane::hierarchy {
namespace {

constexpr std::int64_t kSide = HeightSlabs::kSide;

/// A part of a field, less than a block at its end.
struct Block {
  const SampleField& field;
  std::int64_t column, row, columns, rows;

  double height_m(std::int64_t c, std::int64_t r) const {
    return field.is_backed() ? field.behind.row(column + c, row + r)[0]
                             : field.row(row + r)[column + c];
  }
};

struct Slope {
  double per_column_m = 0, per_row_m = 0;
};

/// The least-squares trend of a whole block; none where it has holes or is cut off.
Slope slope_of(const Block& block) {
  if (block.columns < kSide || block.rows < kSide) return {};
  constexpr double kMiddle = (kSide - 1) / 2.0;
  constexpr double kSumOfSquares = kSide * kSide * (kSide * kSide - 1) / 12.0;
  Slope slope;
  for (std::int64_t r = 0; r < kSide; ++r) {
    double sum = 0;
    for (std::int64_t c = 0; c < kSide; ++c) {
      const double height_m = block.height_m(c, r);
      sum += height_m;
      slope.per_column_m += (static_cast<double>(c) - kMiddle) * height_m;
    }
    slope.per_row_m += (static_cast<double>(r) - kMiddle) * sum;
  }
  if (std::isnan(slope.per_row_m)) return {};
  return {slope.per_column_m / kSumOfSquares, slope.per_row_m / kSumOfSquares};
}

HeightSlab slab_of(const Block& block) {
  const Slope slope = slope_of(block);
  double lowest_m = std::numeric_limits<double>::infinity(), highest_m = -lowest_m;
  for (std::int64_t r = 0; r < block.rows; ++r) {
    for (std::int64_t c = 0; c < block.columns; ++c) {
      const double above_m = block.height_m(c, r) - slope.per_column_m * static_cast<double>(c) -
                             slope.per_row_m * static_cast<double>(r);
      // false for samples without a height
      if (above_m < lowest_m) lowest_m = above_m;
      if (above_m > highest_m) highest_m = above_m;
    }
  }
  if (!(lowest_m <= highest_m)) return {};
  return {(lowest_m + highest_m) / 2, slope.per_column_m, slope.per_row_m,
          (highest_m - lowest_m) / 2};
}

}  // namespace

HeightSlabs::HeightSlabs(const SampleField& field)
    : blocks_{(field.columns + kSide - 1) / kSide, (field.rows + kSide - 1) / kSide} {
  slabs_.reserve(static_cast<std::size_t>(blocks_.columns * blocks_.rows));
  for (std::int64_t row = 0; row < field.rows; row += kSide) {
    for (std::int64_t column = 0; column < field.columns; column += kSide) {
      slabs_.push_back(slab_of({field, column, row, std::min(kSide, field.columns - column),
                                std::min(kSide, field.rows - row)}));
    }
  }
}

}  // namespace terrane::hierarchy

#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "core/height_grid.h"

namespace terrane::hierarchy {

/// The heights of a block of samples lie between two parallel planes.
struct HeightSlab {
  float height_m = 0;  ///< of the middle between the planes, over the block's first sample
  float per_column_m = 0;
  float per_row_m = 0;
  float half_m = -1;  ///< from the middle to either plane; below 0 where no sample has a height

  bool is_empty() const { return half_m < 0; }
  /// Of the middle, so many columns and rows from the first sample.
  double middle_m(double columns, double rows) const {
    return double{height_m} + columns * double{per_column_m} + rows * double{per_row_m};
  }
};

/// A slab for each square block of a grid. What is flat and keeps clear of both planes at the
/// block's corners keeps clear of all samples between.
class HeightSlabs {
 public:
  HeightSlabs() = default;
  /// Of blocks without heights yet.
  /// \param side  samples along a block; the last ones may be smaller.
  HeightSlabs(const GridShape& shape, std::int64_t side)
      : side_(side),
        columns_((shape.columns + side - 1) / side),
        slabs_(static_cast<std::size_t>(columns_ * ((shape.rows + side - 1) / side))) {}

  bool empty() const { return slabs_.empty(); }
  std::int64_t side() const { return side_; }
  /// Counted in blocks.
  GridShape shape() const { return {columns_, std::ssize(slabs_) / columns_}; }
  /// Of the block of so many blocks to the right and down.
  HeightSlab& at(std::int64_t column, std::int64_t row) { return slabs_[number(column, row)]; }
  const HeightSlab& at(std::int64_t column, std::int64_t row) const {
    return slabs_[number(column, row)];
  }

 private:
  std::size_t number(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>(row * columns_ + column);
  }

  std::int64_t side_ = 1, columns_ = 0;
  std::vector<HeightSlab> slabs_;
};

/// The slopes of a whole block's least-squares plane, in metres per column and row; NaN where it
/// has holes. \param height_m  (column, row) of the block to its height; NaN where there is none.
template <class HeightAt>
std::pair<double, double> slopes_of(std::int64_t side, const HeightAt& height_m) {
  const auto n = static_cast<double>(side);
  const double middle = (n - 1) / 2, sum_of_squares = n * n * (n * n - 1) / 12;
  double per_column = 0, per_row = 0;
  for (std::int64_t r = 0; r < side; ++r) {
    double sum = 0;
    for (std::int64_t c = 0; c < side; ++c) {
      const double height = height_m(c, r);
      sum += height;
      per_column += (static_cast<double>(c) - middle) * height;
    }
    per_row += (static_cast<double>(r) - middle) * sum;
  }
  return {per_column / sum_of_squares, per_row / sum_of_squares};
}

/// The slab of a block: along its trend; level where it has holes or is cut off.
/// \param side      of a block that is not; at least 2.
/// \param height_m  see slopes_of().
template <class HeightAt>
HeightSlab slab_around(std::int64_t columns, std::int64_t rows, std::int64_t side,
                       const HeightAt& height_m) {
  HeightSlab slab;
  if (columns == side && rows == side) {
    const auto [per_column, per_row] = slopes_of(side, height_m);
    if (!std::isnan(per_row)) {
      slab.per_column_m = static_cast<float>(per_column);
      slab.per_row_m = static_cast<float>(per_row);
    }
  }
  double lowest_m = std::numeric_limits<double>::infinity(), highest_m = -lowest_m;
  for (std::int64_t r = 0; r < rows; ++r) {
    for (std::int64_t c = 0; c < columns; ++c) {
      const double above_m =
          height_m(c, r) - slab.middle_m(static_cast<double>(c), static_cast<double>(r));
      // false for samples without a height
      if (above_m < lowest_m) lowest_m = above_m;
      if (above_m > highest_m) highest_m = above_m;
    }
  }
  if (!(lowest_m <= highest_m)) return {};
  constexpr double kRounding = 1.2e-7;  // of floats
  slab.height_m = static_cast<float>((lowest_m + highest_m) / 2);
  slab.half_m = static_cast<float>((highest_m - lowest_m) / 2 * (1 + kRounding) +
                                   kRounding * std::max(std::abs(lowest_m), std::abs(highest_m)));
  return slab;
}

}  // namespace terrane::hierarchy

#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hierarchy/collapse/sample_field.h"

namespace terrane::hierarchy {

/// The heights of a square block of samples lie between two parallel planes.
struct HeightSlab {
  double height_m = 0;  ///< of the middle between the planes, over the block's first sample
  double per_column_m = 0;
  double per_row_m = 0;
  double half_m = -1;  ///< from the middle to either plane; below 0 where no sample has a height

  bool is_empty() const { return half_m < 0; }
};

/// A slab for each block of a field: what keeps clear of both its planes at the block's corners,
/// and is flat, keeps clear of all samples between. So most of a field needs no look at its
/// samples.
class HeightSlabs {
 public:
  static constexpr std::int64_t kSide = 8;  ///< samples along a block

  HeightSlabs() = default;
  /// \pre the field has all its heights
  explicit HeightSlabs(const SampleField& field);

  bool empty() const { return slabs_.empty(); }
  /// Of the block of so many blocks to the right and down.
  const HeightSlab& at(std::int64_t column, std::int64_t row) const {
    return slabs_[static_cast<std::size_t>(row * blocks_.columns + column)];
  }

 private:
  GridShape blocks_;
  std::vector<HeightSlab> slabs_;
};

}  // namespace terrane::hierarchy

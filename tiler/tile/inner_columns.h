#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <utility>

#include "hierarchy/collapse/sample_field.h"

namespace terrane::tiler {

/// The columns of each row of samples that lie in a triangle over the grid, away from its sides.
class InnerColumns {
 public:
  /// \param margin_cells  that a sample is away from each side at least.
  InnerColumns(const hierarchy::FieldPoint& a, const hierarchy::FieldPoint& b,
               const hierarchy::FieldPoint& c, double margin_cells);

  /// The first and the last from \p first to \p last; none if the first is greater.
  std::pair<std::int64_t, std::int64_t> of_row(std::int64_t row, std::int64_t first,
                                               std::int64_t last) const;

 private:
  /// A side, moved inwards.
  struct Side {
    double at_row_0, per_row;
    double column(double row) const { return at_row_0 + per_row * row; }
  };

  std::array<Side, 3> left_, right_;
  std::size_t lefts_ = 0, rights_ = 0;
  double top_ = -std::numeric_limits<double>::infinity();
  double bottom_ = std::numeric_limits<double>::infinity();
};

}  // namespace terrane::tiler

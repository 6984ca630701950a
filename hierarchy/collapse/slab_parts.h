#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/collapse/height_slabs.h"
#include "hierarchy/collapse/row_spans.h"

namespace terrane::hierarchy {

/// Calls visit(span) for the parts of rows between sides that lie in one block of slabs each, less
/// those blocks that are clear: rows of blocks from the top, in each the blocks from the left.
/// Stops and returns false as soon as visit does.
///
/// \param shape        of the grid of samples; columns and rows count from its first sample.
/// \param slack_cells  samples this near to the sides count as between them.
/// \param is_clear     called with the column and row of a block, counted in blocks.
template <class IsClear, class Visit>
bool for_each_part_not_clear(std::span<const FieldSide> sides, const GridShape& shape,
                             double slack_cells, const HeightSlabs& slabs, const IsClear& is_clear,
                             const Visit& visit) {
  const std::int64_t side = slabs.side();
  // half a block, and what rounding may add
  const double reach = 0.51 + slack_cells / static_cast<double>(side);
  const SpansBetween rows(sides, shape, slack_cells);
  const SpansBetween rows_of_blocks(sides, slabs.shape(), reach, side);
  std::vector<RowSpan> spans;
  const auto list_spans = [&](std::int64_t row_of_blocks) {
    const std::int64_t first = std::max(rows.first_row(), row_of_blocks * side);
    const std::int64_t last = std::min(rows.last_row(), row_of_blocks * side + side - 1);
    for (std::int64_t row = first; row <= last; ++row) spans.push_back(rows.of_row(row));
  };
  for (std::int64_t r = rows_of_blocks.first_row(); r <= rows_of_blocks.last_row(); ++r) {
    const RowSpan blocks = rows_of_blocks.of_row(r);
    spans.clear();
    for (std::int64_t block = blocks.first; block <= blocks.last; ++block) {
      if (is_clear(block, r)) continue;
      if (spans.empty()) list_spans(r);
      for (const RowSpan& span : spans) {
        const RowSpan part{span.row, std::max(span.first, block * side),
                           std::min(span.last, block * side + side - 1)};
        if (!part.is_empty() && !visit(part)) return false;
      }
    }
  }
  return true;
}

}  // namespace terrane::hierarchy

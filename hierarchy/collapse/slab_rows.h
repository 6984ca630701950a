#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace terrane::hierarchy {

/// Columns of a row of samples.
struct RowSpan {
  std::int64_t row, first, last;
};

/// Gathers the rows of samples under something until a row of blocks is complete, and visits them
/// together.
/// \tparam Visit  called with a std::span<const RowSpan>, none of them empty; returns whether to go
///                on.
template <class Visit>
class SlabRows {
 public:
  /// \param side  samples along a block.
  SlabRows(std::int64_t side, const Visit& visit) : side_(side), visit_(visit) {}

  /// \param row  below the last one.
  /// \return whether all visits so far said so.
  bool add(std::int64_t row, std::int64_t first, std::int64_t last) {
    if (!spans_.empty() && row / side_ != spans_.front().row / side_ && !end()) return false;
    spans_.push_back({row, first, last});
    return true;
  }

  /// Visits what is left.
  bool end() {
    const bool goes_on = spans_.empty() || visit_(std::span<const RowSpan>(spans_));
    spans_.clear();
    return goes_on;
  }

 private:
  std::int64_t side_;
  const Visit& visit_;
  std::vector<RowSpan> spans_;
};

/// Calls visit(first column, last column) for each block that spans of its row of blocks reach.
/// Stops and returns false as soon as visit does.
template <class Visit>
bool for_each_block_of(std::span<const RowSpan> spans, std::int64_t side, const Visit& visit) {
  const std::int64_t begin = std::ranges::min(spans, {}, &RowSpan::first).first / side;
  const std::int64_t end = std::ranges::max(spans, {}, &RowSpan::last).last / side + 1;
  for (std::int64_t block = begin; block < end; ++block) {
    const std::int64_t first = block * side, last = first + side - 1;
    const bool is_reached = std::ranges::any_of(
        spans, [&](const RowSpan& span) { return span.first <= last && span.last >= first; });
    if (is_reached && !visit(first, last)) return false;
  }
  return true;
}

/// Calls visit(span) for the parts of spans that lie from one column to another. Stops and returns
/// false as soon as visit does.
template <class Visit>
bool for_each_part_of(std::span<const RowSpan> spans, std::int64_t first, std::int64_t last,
                      const Visit& visit) {
  return std::ranges::all_of(spans, [&](const RowSpan& span) {
    const RowSpan part{span.row, std::max(span.first, first), std::min(span.last, last)};
    return part.first > part.last || visit(part);
  });
}

}  // namespace terrane::hierarchy

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "hierarchy/collapse/coded_heights.h"
#include "hierarchy/collapse/lanes.h"

namespace terrane::hierarchy {

/// Eight heights of a row, from the k-th on, the same bits as one by one; NaN where there is none.
TERRANE_LANES_INLINE std::array<HalfLanes, 2> lanes_of(const CodedHeights::Row& row,
                                                       std::size_t k) {
  using Codes [[gnu::vector_size(2 * kLanes)]] = std::uint16_t;
  Codes codes;
  std::memcpy(&codes, row.codes + k, sizeof codes);
  const auto numbers = __builtin_convertvector(codes, LaneMask);
  const LaneMask is_none = numbers == CodedHeights::kNone;
  const HalfLanes none = HalfLanes{} + std::numeric_limits<double>::quiet_NaN();
  std::array<HalfLanes, 2> heights_m;
  for (std::size_t half = 0; half < 2; ++half) {
    heights_m[half] = row.lowest_m + row.step_m * as_doubles(numbers, half);
    heights_m[half] = widened(is_none, half) ? none : heights_m[half];
  }
  return heights_m;
}

}  // namespace terrane::hierarchy

#pragma once

#include <span>
#include <vector>

namespace terrane::tiler {

/// Puts a tile into a quarter of the coarser tile that covers it: the mean of 2 x 2 pixels, of
/// those that have data; NaN where none has.
///
/// \param tile     side_px * side_px heights, row by row.
/// \param right, lower  which quarter of \p coarser.
/// \pre side_px is even.
void add_half_size(std::span<const float> tile, int side_px, bool right, bool lower,
                   std::vector<float>& coarser);

}  // namespace terrane::tiler

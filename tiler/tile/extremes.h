#pragma once

#include <cstdint>
#include <vector>

#include "hierarchy/collapse/sample_field.h"
#include "tiler/tile/datum_heights.h"

namespace terrane::tiler {

/// Samples that add_extremes() takes of each part at most.
inline constexpr std::size_t kExtremesPerPart = 10;

/// Appends, for each square part of a window, the samples that stick out most above and below the
/// trend of the window, and above and below planes tilted against that; each once.
///
/// \param around      of the DEM; larger than its parts, as the trend of a part alone would follow
///                    what is rough in it.
/// \param part_cells  along a part; those at the window's end may be smaller.
void add_extremes(const DatumHeights& heights, const Window& around, std::int64_t part_cells,
                  std::vector<hierarchy::FieldSample>& result);

}  // namespace terrane::tiler

#pragma once

#include "core/height_grid.h"

namespace terrane::tiler {

/// Most cells along a side of a DEM: as far as hierarchy::GridPoint counts, and its orient2d() is
/// exact.
inline constexpr std::int64_t kMostCells = (1 << 17) - 1;

/// \throws InputError if a side of the DEM is longer than kMostCells.
void check_size(GridShape shape);

}  // namespace terrane::tiler

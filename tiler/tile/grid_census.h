#pragma once

#include <cstdint>

#include "core/height_source.h"

namespace terrane::tiler {

/// What the full-resolution triangulation (hierarchy/mesh/grid_triangles.h) of a DEM has.
struct GridCensus {
  std::int64_t samples = 0;  ///< that are corners of triangles
  std::int64_t triangles = 0;
};

/// Counts without triangulating, with a strip of rows in memory at a time.
/// \throws InputError if the DEM cannot be read.
GridCensus count_grid(const HeightSource& heights, std::int64_t samples_at_once = 16 << 20);

}  // namespace terrane::tiler

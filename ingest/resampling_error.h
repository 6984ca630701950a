#pragma once

#include "core/geodetic_grid.h"
#include "ingest/dem.h"
#include "ingest/geoid.h"

namespace terrane::ingest {

/// How far the samples of a DEM are from what it was resampled to.
struct ResamplingError {
  double max_m = 0;
  double rms_m = 0;
  std::int64_t samples = 0;
};

/// Measures, at each sample with a height, the vertical distance to the surface between the posts
/// (post_surface.h).
///
/// \param geoid  what the DEM's heights are over; null: the ellipsoid.
ResamplingError measure_resampling(const Dem& dem, const GeodeticHeights& heights,
                                   const Geoid* geoid);

}  // namespace terrane::ingest

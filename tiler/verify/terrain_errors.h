#pragma once

#include <cstdint>
#include <vector>

#include "core/georeference.h"
#include "core/height_source.h"
#include "core/progress.h"
#include "tiler/verify/terrain_layer.h"
#include "tiler/verify/undulation.h"

namespace terrane::verify {

/// What the DEM's samples say of one zoom.
struct TerrainErrors {
  double max_m = 0;
  double square_sum_m2 = 0;
  std::int64_t samples = 0;
  std::int64_t uncovered = 0;
  std::int64_t over_tolerance = 0;
  LonLat worst;  ///< where the largest error is
};

/// Measures every zoom at every sample of the DEM that has a height, as flat triangles between
/// Earth-centred places, along the ellipsoid's normal.
///
/// In memory are the tiles around one strip of the DEM.
std::vector<TerrainErrors> measure_terrain(const TerrainLayer& layer, const HeightSource& heights,
                                           const Georeference& place, const Undulation& undulation,
                                           Progress& progress);

}  // namespace terrane::verify

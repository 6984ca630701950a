#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/georeference.h"
#include "core/height_source.h"
#include "tiler/verify/water_shores.h"

namespace terrane::verify {

/// What was found of water in a reference: the heights that a mesh is held against.
struct WaterFindings {
  std::int64_t under_water = 0;  ///< samples farther from any shore than the tolerance, inside
  std::int64_t wrong = 0;        ///< samples that have not the height that they ought to have
  std::vector<std::optional<float>> heights_m;  ///< of each body with a sample clearly inside
  std::vector<std::string> problems;
};

/// Checks that a reference is the DEM on land and one height in each body of water.
///
/// Shores may lie off their place by the tolerance, so samples that near to one are not judged, nor
/// those in several bodies at once. Places go forward, from the grid to the polygons: the builder
/// goes the other way.
///
/// \throws InputError if a height cannot be read.
WaterFindings check_water(const HeightSource& dem, const HeightSource& reference,
                          const Georeference& place, std::span<const WaterArea> areas,
                          double tolerance_m);

}  // namespace terrane::verify

#pragma once

#include <filesystem>

#include "core/georeference.h"
#include "core/height_source.h"
#include "core/progress.h"
#include "tiler/verify/picture_report.h"

namespace terrane::verify {

/// Checks heights as pictures (`terrane build --format terrarium|terrain-rgb`, PNG) against the DEM
/// that they were built from: which tiles there are, coarser zooms against finer ones, the finest
/// against the DEM.
///
/// Not judged: pixels in cells of the DEM that lack a height, and beside the DEM.
///
/// \param fill_m  the height of what has no data.
/// \throws InputError if tiles.json or terrane.json is missing or damaged, or lists WebP.
PictureReport verify_pictures(const std::filesystem::path& folder, const HeightSource& heights,
                              const Georeference& place, double fill_m, Progress& progress);

}  // namespace terrane::verify

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/tiling_settings.h"
#include "core/height_statistics.h"
#include "core/progress.h"
#include "ingest/dem.h"
#include "tiler/build.h"

namespace terrane::cli {

/// Builds a DEM onto the geodetic quadtree.
/// \param water  layers of polygons for the water mask.
/// \pre \p out was claimed.
tiler::BuildResult build_geodetic(const ingest::Dem& dem, const HeightStatistics& statistics,
                                  const TilingSettings& settings,
                                  const std::vector<std::string>& water,
                                  const tiler::BuildOptions& build,
                                  const std::filesystem::path& out, Progress& progress);

}  // namespace terrane::cli

#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "cli/tiling_settings.h"
#include "core/height_statistics.h"
#include "core/progress.h"
#include "ingest/dem.h"
#include "tiler/build.h"

namespace terrane::cli {

/// What `terrane build` needs to know for raster tiles of heights.
struct RasterSettings {
  int px = 512;
  std::string image = "png";
};

/// The command line's part of it; what is not given stays as it is.
struct RasterOptionsGiven {
  std::optional<int> px;
  std::optional<std::string> image;
};
void add_raster_options(CLI::App& command, RasterOptionsGiven& given);
void apply(const RasterOptionsGiven& given, RasterSettings& settings);

/// \throws ConfigError for a size or a format of pictures that is not known.
void check(const RasterSettings& settings);

/// The lines of a settings file that make these settings.
std::string to_toml(const RasterSettings& settings);

/// Writes a DEM as pictures of heights in web mercator.
/// \pre \p out was claimed.
tiler::BuildResult build_raster(const ingest::Dem& dem, const HeightStatistics& statistics,
                                const TilingSettings& tiling, const RasterSettings& settings,
                                const tiler::BuildOptions& build, const std::filesystem::path& out,
                                Progress& progress);

}  // namespace terrane::cli

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/raster_build.h"
#include "cli/tiling_settings.h"
#include "ingest/dem.h"
#include "ingest/drape.h"
#include "ingest/features.h"
#include "tiler/build.h"

namespace terrane::cli {

/// Everything that decides what `terrane build` writes.
struct BuildSettings {
  std::vector<std::string> dem;
  ingest::OpenOptions ingest;
  ingest::FeatureOptions features;
  ingest::DrapeOptions drape;
  tiler::BuildOptions build;
  TilingSettings tiling;
  RasterSettings raster;
};

/// Reads settings from TOML, over those that are given. Keys: see config/.
/// \throws ConfigError that names file, line and key, for an unknown key, a value of the wrong type
///         or out of range; InputError if the file cannot be read.
void read_settings(const std::filesystem::path& file, BuildSettings& settings);

/// Reads the lines and the water of a native build; the DEM's samples in water are at its height
/// from then on.
GridFeatures read_features(const BuildSettings& settings, ingest::Dem& dem, Progress& progress);

/// The settings as TOML from which the same output can be built again: less `jobs`, which does not
/// change it, and with full paths.
std::string to_toml(const BuildSettings& settings);

}  // namespace terrane::cli

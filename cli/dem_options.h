#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ingest/dem.h"
#include "ingest/features.h"

namespace terrane::cli {

/// What a command line says about the DEM to read, and nothing of what it leaves open.
struct DemOptions {
  std::vector<std::string> dem;
  std::optional<int> band;
  std::optional<std::string> nodata, vertical_unit, crs;
  std::vector<std::string> lines, water;
  std::optional<double> water_height_m;
};

/// Adds the DEM and the options that describe it to a subcommand.
/// \return the option of the DEM itself.
CLI::Option* add_dem_options(CLI::App& command, DemOptions& options);

/// Puts what was given over \p settings.
/// \throws ConfigError for an unknown vertical unit.
void apply(const DemOptions& options, ingest::OpenOptions& settings);

/// Adds the options for lines and water that a mesh keeps.
void add_feature_options(CLI::App& command, DemOptions& options);
void apply(const DemOptions& options, ingest::FeatureOptions& settings);

/// \throws ConfigError with the known words, if it is none of them.
ingest::VerticalUnit vertical_unit_of(const std::string& word);

}  // namespace terrane::cli

#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>

#include "core/progress.h"
#include "ingest/dem.h"
#include "ingest/geoid.h"

namespace terrane::cli {

/// Which tiling `terrane build` writes and in which format, what its heights are over, and what the
/// tilings have in common that resample the DEM.
struct TilingSettings {
  std::string scheme = "native";
  std::string format = "3dtiles";
  std::string geoid;  ///< "egm96", a file, "none"; empty: as the DEM says
  std::optional<int> max_zoom;
  double fill_m = 0;

  bool is_geodetic() const { return scheme == "geodetic"; }
  bool is_raster() const { return format == "terrarium" || format == "terrain-rgb"; }
  /// Tiles of the DEM's own grid?
  bool is_native() const { return !is_geodetic() && !is_raster(); }
  bool has_water_masks() const { return format == "quantized-mesh"; }
};

/// The command line's part of it; what is not given stays as it is.
struct TilingOptionsGiven {
  std::optional<std::string> scheme, format, geoid;
  std::optional<int> max_zoom;
  std::optional<double> fill_m;
};
void add_tiling_options(CLI::App& command, TilingOptionsGiven& given);
void apply(const TilingOptionsGiven& given, TilingSettings& settings);

/// \throws ConfigError for a format that its scheme does not have, or an option that is of no use.
void check(const TilingSettings& settings);

/// The geoid that a DEM's heights are over; null: the ellipsoid. Says what was decided and why.
std::unique_ptr<ingest::Geoid> geoid_of(const ingest::Dem& dem, const TilingSettings& settings,
                                        Progress& progress);

/// Gives a DEM's heights over the ellipsoid, for tiles of its own grid. Nothing is to be done for
/// one without a CRS, which has no place on the ellipsoid. \throws ConfigError if a geoid was asked
/// for all the same.
void raise_to_the_ellipsoid(ingest::Dem& dem, const TilingSettings& settings, Progress& progress);

}  // namespace terrane::cli

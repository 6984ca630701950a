#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/height_statistics.h"
#include "core/progress.h"
#include "ingest/dem.h"
#include "ingest/geoid.h"
#include "tiler/build.h"

namespace terrane::cli {

/// What `terrane build` needs to know beyond the rest for tiles of the geodetic quadtree.
struct GeodeticSettings {
  std::string scheme = "native";
  std::string format = "3dtiles";
  std::string geoid;  ///< "egm96", a file, "none"; empty: as the DEM says
  std::optional<int> max_zoom;
  double fill_m = 0;

  bool is_geodetic() const { return scheme == "geodetic"; }
  bool is_raster() const { return format == "terrarium" || format == "terrain-rgb"; }
  bool has_water_masks() const { return format == "quantized-mesh"; }
};

/// The command line's part of it; what is not given stays as it is.
struct GeodeticOptionsGiven {
  std::optional<std::string> scheme, format, geoid;
  std::optional<int> max_zoom;
  std::optional<double> fill_m;
};
void add_geodetic_options(CLI::App& command, GeodeticOptionsGiven& given);
void apply(const GeodeticOptionsGiven& given, GeodeticSettings& settings);

/// \throws ConfigError for a format that its scheme does not have, or an option that is of no use.
void check(const GeodeticSettings& settings);

/// The geoid that a DEM's heights are over; null: the ellipsoid. Says what was decided and why.
std::unique_ptr<ingest::Geoid> geoid_of(const ingest::Dem& dem, const GeodeticSettings& settings,
                                        Progress& progress);

/// Gives a DEM's heights over the ellipsoid, for tiles of its own grid. Nothing is to be done for
/// one without a CRS, which has no place on the ellipsoid. \throws ConfigError if a geoid was asked
/// for all the same.
void raise_to_the_ellipsoid(ingest::Dem& dem, const GeodeticSettings& settings, Progress& progress);

/// Builds a DEM onto the geodetic quadtree.
/// \param water  layers of polygons for the water mask.
/// \pre \p out was claimed.
tiler::BuildResult build_geodetic(const ingest::Dem& dem, const HeightStatistics& statistics,
                                  const GeodeticSettings& settings,
                                  const std::vector<std::string>& water,
                                  const tiler::BuildOptions& build,
                                  const std::filesystem::path& out, Progress& progress);

}  // namespace terrane::cli

#include "cli/tiling_settings.h"

#include <fmt/format.h>

#include "core/errors.h"

namespace terrane::cli {
namespace {

void check_raster(const TilingSettings& settings) {
  if (settings.is_geodetic()) {
    throw ConfigError(fmt::format("--scheme geodetic: {} is in web mercator. Leave --scheme away",
                                  settings.format));
  }
  if (settings.geoid.empty()) return;
  throw ConfigError(
      fmt::format("--geoid: {} keeps heights as they are, over sea level as maps have them. Leave "
                  "it away",
                  settings.format));
}

}  // namespace

void add_tiling_options(CLI::App& command, TilingOptionsGiven& given) {
  command.add_option("--scheme", given.scheme,
                     "Tiling: native, the DEM's own grid; or geodetic, the global quadtree of "
                     "longitudes and latitudes, to which the DEM is resampled [native]");
  command.add_option(
      "--format", given.format,
      "What to write: 3dtiles (native); quantized-mesh or 3dtiles-terrain (geodetic); terrarium or "
      "terrain-rgb: pictures of heights in web mercator [3dtiles, quantized-mesh]");
  command.add_option("--geoid", given.geoid,
                     "What the heights are over: egm96, a file with a grid, or none: the WGS 84 "
                     "ellipsoid [as the DEM's CRS says, else none]");
  command.add_option("--max-zoom", given.max_zoom,
                     "Finest zoom, 0 to 22, geodetic or of pictures [the coarsest that can hold "
                     "the tolerance at the DEM's samples; for pictures, that has its cells]");
  command.add_option("--fill", given.fill_m,
                     "Geodetic and pictures: height in metres of what the DEM has no data for [0]");
}

void apply(const TilingOptionsGiven& given, TilingSettings& settings) {
  if (given.scheme) settings.scheme = *given.scheme;
  if (given.format) settings.format = *given.format;
  if (!given.format && settings.is_geodetic() && settings.format == "3dtiles") {
    settings.format = "quantized-mesh";
  }
  if (given.geoid) settings.geoid = *given.geoid;
  if (given.max_zoom) settings.max_zoom = given.max_zoom;
  if (given.fill_m) settings.fill_m = *given.fill_m;
}

void check(const TilingSettings& settings) {
  if (settings.scheme != "native" && settings.scheme != "geodetic") {
    throw ConfigError(
        fmt::format("--scheme {}: is not known. Use native or geodetic", settings.scheme));
  }
  if (settings.is_raster()) {
    check_raster(settings);
    return;
  }
  const bool is_known = settings.is_geodetic() ? settings.format == "quantized-mesh" ||
                                                     settings.format == "3dtiles-terrain"
                                               : settings.format == "3dtiles";
  if (!is_known) {
    throw ConfigError(fmt::format(
        "--format {}: is not one of --scheme {}. Use {}", settings.format, settings.scheme,
        settings.is_geodetic() ? "quantized-mesh or 3dtiles-terrain" : "3dtiles"));
  }
  if (settings.is_geodetic()) return;
  const char* const useless = settings.max_zoom      ? "--max-zoom"
                              : settings.fill_m != 0 ? "--fill"
                                                     : nullptr;
  if (useless == nullptr) return;
  throw ConfigError(
      fmt::format("{}: is for --scheme geodetic alone. Leave it away, or add that", useless));
}

std::unique_ptr<ingest::Geoid> geoid_of(const ingest::Dem& dem, const TilingSettings& settings,
                                        Progress& progress) {
  if (settings.geoid == "none") return nullptr;
  if (!settings.geoid.empty()) return ingest::open_geoid(settings.geoid);
  const std::string& vertical = dem.description().vertical_crs;
  if (vertical.empty()) {
    progress.note(fmt::format(
        "{}: does not say what its heights are over; they are taken as over the WGS 84 ellipsoid. "
        "For heights over sea level add --geoid egm96",
        dem.name()));
    return nullptr;
  }
  if (vertical == ingest::kEllipsoidalHeight) return nullptr;
  if (vertical == "EGM96 height") {
    progress.note(fmt::format("{}: heights are over EGM96, as its CRS says", dem.name()));
    return ingest::open_geoid("egm96");
  }
  progress.note(fmt::format(
      "{}: heights are over '{}', for which no grid is known; egm96 is used instead, which is "
      "within a few metres of other sea levels. Name a better one with --geoid, or none",
      dem.name(), vertical));
  return ingest::open_geoid("egm96");
}

void raise_to_the_ellipsoid(ingest::Dem& dem, const TilingSettings& settings, Progress& progress) {
  if (!dem.place().crs_wkt().empty()) {
    if (auto geoid = geoid_of(dem, settings, progress)) dem.raise(std::move(geoid));
    return;
  }
  if (settings.geoid.empty() || settings.geoid == "none") return;
  throw ConfigError(
      fmt::format("--geoid {}: {} has no CRS, so it lies nowhere on a geoid. Name it with --crs",
                  settings.geoid, dem.name()));
}

}  // namespace terrane::cli

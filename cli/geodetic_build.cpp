#include "cli/geodetic_build.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/temporary_file.h"
#include "core/errors.h"
#include "ingest/resample.h"
#include "ingest/resampling_error.h"
#include "ingest/water_mask.h"
#include "tiler/geodetic/build_geodetic.h"

namespace terrane::cli {
namespace {

constexpr const char* k3dTilesTerrain = "3dtiles-terrain";

std::string described(const GeodeticSettings& settings, const std::vector<std::string>& water,
                      const ingest::Geoid* geoid) {
  return fmt::format("{}; no data as {} m; {}; water: {}",
                     settings.max_zoom ? fmt::format("zoom {}", *settings.max_zoom) : "any zoom",
                     settings.fill_m, geoid == nullptr ? "over the ellipsoid" : geoid->name(),
                     fmt::join(water, ", "));
}

/// A DEM on the posts of a zoom.
struct Resampled {
  ingest::Resampling plan;
  ingest::ResamplingError error = {};
  std::unique_ptr<GeodeticHeights> heights = nullptr;
};

// what is left of the tolerance for the simplification: at least as much again
constexpr double kShareOfPosts = 0.5;

/// Resamples to the zoom that was asked for, or to the coarsest that leaves room for the tolerance
/// at the DEM's samples.
Resampled resample(const ingest::Dem& dem, const HeightStatistics& statistics,
                   ingest::ResampleOptions options, double tolerance_m,
                   const std::filesystem::path& file, Progress& progress) {
  constexpr int kMostFiner = 2;
  options.fit_to_m = tolerance_m / 8;
  const bool is_asked_for = options.zoom.has_value();
  for (int finer = 0;; ++finer) {
    Resampled result{.plan = ingest::plan_resampling(dem, statistics, options)};
    const GeodeticTiles& tiles = result.plan.tiles;
    progress.note(fmt::format("{}: resampled to zoom {} ({}), {} x {} tiles", dem.name(),
                              tiles.zoom, result.plan.method, tiles.columns, tiles.rows));
    result.heights = ingest::resample(dem, result.plan, options, file, progress);
    result.error = ingest::measure_resampling(dem, *result.heights, options.geoid);
    progress.note(
        fmt::format("{}: its samples are at most {:.2f} m off the posts' surface, RMS "
                    "{:.2f} m",
                    dem.name(), result.error.max_m, result.error.rms_m));
    const bool is_near = result.error.max_m <= kShareOfPosts * tolerance_m;
    if (is_near || is_asked_for || finer == kMostFiner || tiles.zoom == ingest::kFinestZoom) {
      return result;
    }
    options.zoom = tiles.zoom + 1;
  }
}

/// Can a mesh that begins at the posts be within the tolerance of the DEM's samples? Says so if
/// not.
bool can_hold(const Resampled& resampled, const std::string& dem, double tolerance_m,
              Progress& progress) {
  constexpr double kRoom = 0.9;
  if (resampled.error.max_m <= kRoom * tolerance_m) return true;
  progress.note(fmt::format(
      "{}: zoom {} is too coarse for a tolerance of {} m at the DEM's samples; it is held at the "
      "posts, and what the samples are off is in terrane.json. Use a larger --max-zoom or a larger "
      "--tolerance",
      dem, resampled.plan.tiles.zoom, tolerance_m));
  return false;
}

void check_raster(const GeodeticSettings& settings) {
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

void add_geodetic_options(CLI::App& command, GeodeticOptionsGiven& given) {
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

void apply(const GeodeticOptionsGiven& given, GeodeticSettings& settings) {
  if (given.scheme) settings.scheme = *given.scheme;
  if (given.format) settings.format = *given.format;
  if (!given.format && settings.is_geodetic() && settings.format == "3dtiles") {
    settings.format = "quantized-mesh";
  }
  if (given.geoid) settings.geoid = *given.geoid;
  if (given.max_zoom) settings.max_zoom = given.max_zoom;
  if (given.fill_m) settings.fill_m = *given.fill_m;
}

void check(const GeodeticSettings& settings) {
  if (settings.scheme != "native" && settings.scheme != "geodetic") {
    throw ConfigError(
        fmt::format("--scheme {}: is not known. Use native or geodetic", settings.scheme));
  }
  if (settings.is_raster()) {
    check_raster(settings);
    return;
  }
  const bool is_known = settings.is_geodetic() ? settings.format == "quantized-mesh" ||
                                                     settings.format == k3dTilesTerrain
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

std::unique_ptr<ingest::Geoid> geoid_of(const ingest::Dem& dem, const GeodeticSettings& settings,
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

void raise_to_the_ellipsoid(ingest::Dem& dem, const GeodeticSettings& settings,
                            Progress& progress) {
  if (!dem.place().crs_wkt().empty()) {
    if (auto geoid = geoid_of(dem, settings, progress)) dem.raise(std::move(geoid));
    return;
  }
  if (settings.geoid.empty() || settings.geoid == "none") return;
  throw ConfigError(
      fmt::format("--geoid {}: {} has no CRS, so it lies nowhere on a geoid. Name it with --crs",
                  settings.geoid, dem.name()));
}

tiler::BuildResult build_geodetic(const ingest::Dem& dem, const HeightStatistics& statistics,
                                  const GeodeticSettings& settings,
                                  const std::vector<std::string>& water,
                                  const tiler::BuildOptions& build,
                                  const std::filesystem::path& out, Progress& progress) {
  const auto geoid = geoid_of(dem, settings, progress);
  const ingest::ResampleOptions options{
      .zoom = settings.max_zoom, .fill_m = settings.fill_m, .geoid = geoid.get()};
  tiler::GeodeticOptions geodetic{.format = settings.format == k3dTilesTerrain
                                                ? tiler::TerrainFormat::k3dTiles
                                                : tiler::TerrainFormat::kQuantizedMesh,
                                  .tolerance_m = build.tolerance_m,
                                  .jobs = build.jobs,
                                  .source = described(settings, water, geoid.get()),
                                  .resampling = {},
                                  .attribution = build.format.attribution};
  if (!water.empty()) {
    const auto mask = ingest::open_water_mask(water);
    geodetic.water_fingerprint = mask->fingerprint();
    geodetic.water = [mask](double west, double south, double east, double north) {
      return mask->bytes(west, south, east, north);
    };
  }
  if (tiler::is_finished(out, tiler::geodetic_key(statistics, geodetic))) {
    return {.was_up_to_date = true};
  }
  // beside the output and not in it: that folder may be cleared
  const TemporaryFile file{out.string() + ".resampled.tif"};
  const Resampled resampled =
      resample(dem, statistics, options, build.tolerance_m, file.path, progress);
  geodetic.holds_dem_samples = can_hold(resampled, dem.name(), build.tolerance_m, progress);
  geodetic.resampling = {.method = resampled.plan.method,
                         .max_error_m = resampled.error.max_m,
                         .rms_error_m = resampled.error.rms_m};
  return tiler::build_geodetic(*resampled.heights, statistics, geodetic, out, progress);
}

}  // namespace terrane::cli

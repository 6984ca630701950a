#include "cli/geodetic_build.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/temporary_file.h"
#include "ingest/resample.h"
#include "ingest/resampling_error.h"
#include "ingest/water_mask.h"
#include "tiler/geodetic/build_geodetic.h"

namespace terrane::cli {
namespace {

constexpr const char* k3dTilesTerrain = "3dtiles-terrain";

std::string described(const TilingSettings& settings, const std::vector<std::string>& water,
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

}  // namespace

tiler::BuildResult build_geodetic(const ingest::Dem& dem, const HeightStatistics& statistics,
                                  const TilingSettings& settings,
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

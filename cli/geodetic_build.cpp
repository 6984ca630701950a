#include "cli/geodetic_build.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/errors.h"
#include "ingest/geoid.h"
#include "ingest/resample.h"
#include "ingest/resampling_error.h"
#include "ingest/water_mask.h"
#include "tiler/geodetic/build_geodetic.h"

namespace terrane::cli {
namespace {

/// The geoid that a DEM's heights are over; null: the ellipsoid. Says what was decided and why.
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

/// A file that goes with its owner.
struct TemporaryFile {
  std::filesystem::path path;

  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

std::string described(const ingest::Resampling& plan, const GeodeticSettings& settings,
                      const std::vector<std::string>& water, const ingest::Geoid* geoid) {
  return fmt::format("zoom {}, {}; no data as {} m; {}; water: {}", plan.tiles.zoom, plan.method,
                     settings.fill_m, geoid == nullptr ? "over the ellipsoid" : geoid->name(),
                     fmt::join(water, ", "));
}

}  // namespace

void add_geodetic_options(CLI::App& command, GeodeticOptionsGiven& given) {
  command.add_option("--scheme", given.scheme,
                     "Tiling: native, the DEM's own grid; or geodetic, the global quadtree of "
                     "longitudes and latitudes, to which the DEM is resampled [native]");
  command.add_option("--format", given.format,
                     "What to write: 3dtiles (native); quantized-mesh (geodetic) [3dtiles, "
                     "quantized-mesh]");
  command.add_option("--geoid", given.geoid,
                     "Geodetic: what the heights are over: egm96, a file with a grid, or none: the "
                     "WGS 84 ellipsoid [as the DEM's CRS says, else none]");
  command.add_option("--max-zoom", given.max_zoom,
                     "Geodetic: finest zoom, 0 to 22 [the coarsest with cells no larger than the "
                     "DEM's]");
  command.add_option("--fill", given.fill_m,
                     "Geodetic: height in metres of what the DEM has no data for [0]");
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
  const char* const wanted = settings.is_geodetic() ? "quantized-mesh" : "3dtiles";
  if (settings.format != wanted) {
    throw ConfigError(fmt::format("--format {}: is not one of --scheme {}. Use {}", settings.format,
                                  settings.scheme, wanted));
  }
  if (settings.is_geodetic()) return;
  const char* const useless = !settings.geoid.empty() ? "--geoid"
                              : settings.max_zoom     ? "--max-zoom"
                              : settings.fill_m != 0  ? "--fill"
                                                      : nullptr;
  if (useless == nullptr) return;
  throw ConfigError(
      fmt::format("{}: is for --scheme geodetic alone. Leave it away, or add that", useless));
}

tiler::BuildResult build_geodetic(const ingest::Dem& dem, const HeightStatistics& statistics,
                                  const GeodeticSettings& settings,
                                  const std::vector<std::string>& water,
                                  const tiler::BuildOptions& build,
                                  const std::filesystem::path& out, Progress& progress) {
  const auto geoid = geoid_of(dem, settings, progress);
  const ingest::ResampleOptions options{
      .zoom = settings.max_zoom, .fill_m = settings.fill_m, .geoid = geoid.get()};
  const ingest::Resampling plan = ingest::plan_resampling(dem, statistics, options);
  tiler::GeodeticOptions geodetic{.tolerance_m = build.tolerance_m,
                                  .jobs = build.jobs,
                                  .source = described(plan, settings, water, geoid.get()),
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
  progress.note(fmt::format("{}: resampled to zoom {} ({}), {} x {} tiles", dem.name(),
                            plan.tiles.zoom, plan.method, plan.tiles.columns, plan.tiles.rows));
  // beside the output and not in it: that folder may be cleared
  const TemporaryFile file{out.string() + ".resampled.tif"};
  const auto heights = ingest::resample(dem, plan, options, file.path, progress);
  const ingest::ResamplingError error = ingest::measure_resampling(dem, *heights, geoid.get());
  progress.note(
      fmt::format("{}: its samples are at most {:.2f} m off the posts' surface, RMS {:.2f} m",
                  dem.name(), error.max_m, error.rms_m));
  geodetic.resampling_max_error_m = error.max_m;
  geodetic.resampling_rms_error_m = error.rms_m;
  return tiler::build_geodetic(*heights, statistics, geodetic, out, progress);
}

}  // namespace terrane::cli

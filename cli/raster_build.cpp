#include "cli/raster_build.h"

#include <fmt/format.h>

#include "cli/temporary_file.h"
#include "core/errors.h"
#include "ingest/height_picture.h"
#include "ingest/mercator_resample.h"
#include "tiler/raster/build_raster.h"

namespace terrane::cli {

void add_raster_options(CLI::App& command, RasterOptionsGiven& given) {
  command.add_option("--raster-px", given.px,
                     "Raster tiles: pixels along a tile, 256 or 512 [512]");
  command.add_option("--raster-image", given.image,
                     "Raster tiles: png, or webp without loss [png]");
}

void apply(const RasterOptionsGiven& given, RasterSettings& settings) {
  if (given.px) settings.px = *given.px;
  if (given.image) settings.image = *given.image;
}

void check(const RasterSettings& settings) {
  if (settings.px != 256 && settings.px != 512) {
    throw ConfigError(fmt::format("--raster-px {}: must be 256 or 512", settings.px));
  }
  if (settings.image != "png" && settings.image != "webp") {
    throw ConfigError(
        fmt::format("--raster-image {}: is not known. Use png or webp", settings.image));
  }
}

std::string to_toml(const RasterSettings& settings) {
  return fmt::format("\n[raster]\npx = {}\nimage = \"{}\"\n", settings.px, settings.image);
}

tiler::BuildResult build_raster(const ingest::Dem& dem, const HeightStatistics& statistics,
                                const TilingSettings& tiling, const RasterSettings& settings,
                                const tiler::BuildOptions& build, const std::filesystem::path& out,
                                Progress& progress) {
  const ingest::MercatorPlan plan =
      ingest::plan_mercator(dem, {.tile_px = settings.px, .zoom = tiling.max_zoom});
  const bool is_webp = settings.image == "webp";
  const tiler::RasterOptions options{
      .encoding = tiler::height_encoding_of(tiling.format).value(),
      .fill_m = tiling.fill_m,
      .extension = settings.image,
      .encode = [is_webp](std::span<const std::uint8_t> rgb,
                          int side_px) { return ingest::encode_lossless(rgb, side_px, is_webp); },
      .bounds_deg = {plan.west_deg, plan.south_deg, plan.east_deg, plan.north_deg},
      .source = fmt::format("web mercator to zoom {}, {} px a tile, {}", plan.tiles.zoom,
                            plan.tile_px, plan.method),
      .name = dem.name(),
      .attribution = build.format.attribution};
  tiler::check_range(statistics, options);
  if (tiler::is_finished_raster(out, tiler::raster_key(statistics, options))) {
    return {.was_up_to_date = true};
  }
  progress.note(fmt::format("{}: resampled to zoom {} of web mercator ({}), {} x {} tiles of {} px",
                            dem.name(), plan.tiles.zoom, plan.method, plan.tiles.columns,
                            plan.tiles.rows, plan.tile_px));
  // beside the output and not in it: that folder may be cleared
  const TemporaryFile file{out.string() + ".resampled.tif"};
  const auto heights = ingest::resample_to_mercator(dem, plan, file.path, progress);
  return tiler::build_raster(*heights, statistics, options, out, progress);
}

}  // namespace terrane::cli

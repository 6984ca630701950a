#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/build_settings.h"
#include "cli/commands.h"
#include "cli/dem_options.h"
#include "cli/geodetic_build.h"
#include "cli/raster_build.h"
#include "cli/terminal_progress.h"
#include "cli/tile_options.h"
#include "core/errors.h"
#include "ingest/scan.h"
#include "tiler/dem_size.h"
#include "tiler/files/folder_lock.h"
#include "tiler/files/output_folder.h"
#include "tiler/files/whole_file.h"
#include "viewer/server/viewer_files.h"

namespace terrane::cli {
namespace {

/// The command line; what is not given comes from the settings file, or is the default.
struct BuildCommand {
  DemOptions dem;
  TileOptions tiles;
  std::filesystem::path out;
  std::string config;
  bool force = false;
  std::optional<int> tile_cells, levels_per_octave, effort, jobs;
  std::optional<double> tolerance_m;
  TilingOptionsGiven tiling;
  RasterOptionsGiven raster;
};

template <class From, class To>
void override_with(const std::optional<From>& given, To& setting) {
  if (given) setting = *given;
}

/// How tiles of the DEM's own grid are written is of no effect on others.
void refuse_tile_options(const TileOptions& options, const std::string& format) {
  if (format == "3dtiles-terrain" && options.compression == "meshopt") {
    throw ConfigError(
        "--compression meshopt: CesiumJS takes places of terrain as 16 bits of the tile then, "
        "which "
        "hold no tolerance. Leave it away");
  }
  const char* const useless = first_of_native_tiles(options);
  if (useless == nullptr) return;
  throw ConfigError(
      fmt::format("{}: has no meaning for --format {}. Leave it away", useless, format));
}

/// Options that would be of no effect.
void refuse_native_options(const BuildCommand& command, const BuildSettings& settings) {
  const char* const useless = command.tile_cells                 ? "--tile-cells"
                              : command.levels_per_octave        ? "--levels-per-octave"
                              : command.effort                   ? "--effort"
                              : !settings.features.lines.empty() ? "--lines"
                              : settings.features.water_height_m ? "--water-height"
                              : !settings.drape.images.empty()   ? "--texture"
                                                                 : nullptr;
  if (useless != nullptr) {
    throw ConfigError(
        fmt::format("{}: is for --scheme native alone. Leave it away, or add that", useless));
  }
  if (!settings.tiling.has_water_masks() && !settings.features.water.empty()) {
    throw ConfigError(
        fmt::format("--water: --format {} has no water masks. Leave it away, or use "
                    "--format quantized-mesh",
                    settings.tiling.format));
  }
}

/// Options of meshes, where pictures are to be written; and the other way round.
void refuse_other_formats(const BuildCommand& command, const BuildSettings& settings) {
  const bool is_raster = settings.tiling.is_raster();
  const char* const useless = !is_raster                       ? (command.raster.px      ? "--raster-px"
                                                                  : command.raster.image ? "--raster-image"
                                                                                         : nullptr)
                              : command.tolerance_m            ? "--tolerance"
                              : command.tile_cells             ? "--tile-cells"
                              : command.levels_per_octave      ? "--levels-per-octave"
                              : command.effort                 ? "--effort"
                              : !settings.drape.images.empty() ? "--texture"
                              : !settings.features.lines.empty() ? "--lines"
                                                                 : nullptr;
  if (useless == nullptr) return;
  throw ConfigError(fmt::format("{}: has no meaning for --format {}. Leave it away", useless,
                                settings.tiling.format));
}

BuildSettings resolve(const BuildCommand& command) {
  BuildSettings settings;
  if (!command.config.empty()) read_settings(command.config, settings);
  if (!command.dem.dem.empty()) settings.dem = command.dem.dem;
  apply(command.dem, settings.ingest);
  apply(command.dem, settings.features);
  override_with(command.tolerance_m, settings.build.tolerance_m);
  override_with(command.tile_cells, settings.build.tile_cells);
  override_with(command.levels_per_octave, settings.build.levels_per_octave);
  override_with(command.effort, settings.build.effort);
  override_with(command.jobs, settings.build.jobs);
  apply(command.tiles, settings.build.format);
  apply(command.tiles, settings.drape);
  apply(command.tiling, settings.tiling);
  tiler::check(settings.build);
  check(settings.tiling);
  apply(command.raster, settings.raster);
  check(settings.raster);
  refuse_other_formats(command, settings);
  if (settings.tiling.is_geodetic()) refuse_native_options(command, settings);
  if (!settings.tiling.is_native()) refuse_tile_options(command.tiles, settings.tiling.format);
  if (settings.dem.empty()) {
    throw ConfigError("no DEM given. Name one, or set ingest.dem in the file of --config");
  }
  return settings;
}

void report(const tiler::BuildResult& result, const std::filesystem::path& out) {
  if (result.was_up_to_date) {
    fmt::print("{}: up to date\n", out.string());
    return;
  }
  if (result.triangles == 0) {
    fmt::print("{}: {} zooms, {} tiles, {:.1f} MB\n", out.string(), result.levels, result.tiles,
               static_cast<double>(result.bytes) / 1e6);
    return;
  }
  fmt::print("{}: {} levels, {} tiles, {:.1f} MB; level 0: {} triangles, at most {:.3f} m off\n",
             out.string(), result.levels, result.tiles, static_cast<double>(result.bytes) / 1e6,
             result.triangles, result.max_error_m);
}

/// Null without images.
std::unique_ptr<TextureSource> open_texture(const ingest::DrapeOptions& drape,
                                            const ingest::Dem& dem) {
  if (drape.images.empty()) return nullptr;
  return ingest::open_drape(drape, dem.place(), dem.heights().shape());
}

tiler::BuildResult build_tiles(ingest::Dem& dem, const HeightStatistics& statistics,
                               const BuildSettings& settings, const std::filesystem::path& out,
                               Progress& progress) {
  const TilingSettings& tiling = settings.tiling;
  if (tiling.is_native()) {
    return tiler::build(dem.heights(), dem.place(), statistics, settings.build, out, progress);
  }
  return tiling.is_geodetic() ? build_geodetic(dem, statistics, tiling, settings.features.water,
                                               settings.build, out, progress)
                              : build_raster(dem, statistics, tiling, settings.raster,
                                             settings.build, out, progress);
}

void run(const BuildCommand& command, const CommonOptions& common) {
  BuildSettings settings = resolve(command);
  const auto progress = make_progress(common.quiet);
  const auto dem = ingest::open_dem(settings.dem, settings.ingest, *progress);
  if (!settings.tiling.is_raster()) tiler::check_size(dem->heights().shape());
  if (settings.tiling.is_native()) raise_to_the_ellipsoid(*dem, settings.tiling, *progress);
  if (!settings.tiling.is_geodetic()) {
    settings.build.features = read_features(settings, *dem, *progress);
  }
  const auto texture = open_texture(settings.drape, *dem);
  settings.build.texture = texture.get();
  const HeightStatistics statistics = ingest::scan_heights(*dem, *progress);
  if (settings.tiling.is_native()) {
    tiler::check_place(dem->heights().shape(), dem->place(), statistics, settings.build);
  }
  tiler::OutputFolder(command.out).claim(command.force);
  const tiler::FolderLock lock(command.out);
  const tiler::BuildResult result = build_tiles(*dem, statistics, settings, command.out, *progress);
  // not before: a run that is killed earlier leaves nothing that the next would not know as its own
  if (settings.tiling.is_native()) viewer::write_viewer(command.out);
  tiler::write_whole_file(command.out / "build.toml", to_toml(settings));
  // the build that finished may have been killed while it tidied up
  if (result.was_up_to_date) tiler::OutputFolder(command.out).end();
  report(result, command.out);
}

}  // namespace

void add_build_command(CLI::App& app, const CommonOptions& common) {
  auto command = std::make_shared<BuildCommand>();
  CLI::App* build = app.add_subcommand("build", "Turn a DEM into tiles with levels of detail");
  add_dem_options(*build, command->dem);
  build->add_option("-o,--out", command->out, "Folder to write to")->required();
  build->add_option("--tolerance", command->tolerance_m,
                    "Largest vertical distance of the finest level to any sample, in metres above "
                    "0; doubles with each octave of levels [1]");
  build->add_option("--tile-cells", command->tile_cells,
                    "Cells along a tile of the finest level, 4 to 1024 [64]");
  build->add_option(
      "--levels-per-octave", command->levels_per_octave,
      "Levels in each doubling of the tolerance, 1 to 4: finer steps between them [1]");
  build->add_option("--effort", command->effort,
                    "0 to 3: more time for fewer triangles within the same tolerance [1]");
  add_feature_options(*build, command->dem);
  add_tiling_options(*build, command->tiling);
  add_raster_options(*build, command->raster);
  build->add_option("--jobs", command->jobs, "Threads; 0: one per core [0]");
  add_tile_options(*build, command->tiles);
  build->add_option("--config", command->config,
                    "TOML file with settings; options on the command line win");
  build->add_flag("--force", command->force,
                  "Write into a folder that holds files of somebody else");
  build->callback([command, &common] { run(*command, common); });
}

}  // namespace terrane::cli

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/build_settings.h"
#include "cli/commands.h"
#include "cli/terminal_progress.h"
#include "core/errors.h"
#include "ingest/scan.h"
#include "tiler/output_folder.h"
#include "tiler/whole_file.h"
#include "viewer/server/viewer_files.h"

namespace terrane::cli {
namespace {

/// The command line; what is not given comes from the settings file, or is the default.
struct BuildCommand {
  std::vector<std::string> dem;
  std::filesystem::path out;
  std::string config;
  bool force = false;
  std::optional<int> band, tile_cells, jobs;
  std::optional<double> tolerance_m;
  std::optional<std::string> nodata, vertical_unit, crs;
};

template <class From, class To>
void override_with(const std::optional<From>& given, To& setting) {
  if (given) setting = *given;
}

BuildSettings resolve(const BuildCommand& command) {
  BuildSettings settings;
  if (!command.config.empty()) read_settings(command.config, settings);
  if (!command.dem.empty()) settings.dem = command.dem;
  override_with(command.band, settings.ingest.band);
  override_with(command.nodata, settings.ingest.nodata);
  override_with(command.crs, settings.ingest.crs);
  if (command.vertical_unit) {
    settings.ingest.vertical_unit = vertical_unit_of(*command.vertical_unit);
  }
  override_with(command.tolerance_m, settings.build.tolerance_m);
  override_with(command.tile_cells, settings.build.tile_cells);
  override_with(command.jobs, settings.build.jobs);
  tiler::check(settings.build);
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
  fmt::print("{}: {} levels, {} tiles, {:.1f} MB; level 0: {} triangles, at most {:.3f} m off\n",
             out.string(), result.levels, result.tiles, static_cast<double>(result.bytes) / 1e6,
             result.triangles, result.max_error_m);
}

void run(const BuildCommand& command, const CommonOptions& common) {
  const BuildSettings settings = resolve(command);
  const auto progress = make_progress(common.quiet);
  const auto dem = ingest::open_dem(settings.dem, settings.ingest, *progress);
  const HeightStatistics statistics = ingest::scan_heights(*dem, *progress);
  tiler::OutputFolder(command.out).claim(command.force);
  viewer::write_viewer(command.out);
  tiler::write_whole_file(command.out / "build.toml", to_toml(settings));
  report(tiler::build(dem->heights(), dem->place(), statistics, settings.build, command.out,
                      *progress),
         command.out);
}

}  // namespace

void add_build_command(CLI::App& app, const CommonOptions& common) {
  auto command = std::make_shared<BuildCommand>();
  CLI::App* build = app.add_subcommand("build", "Turn a DEM into tiles with levels of detail");
  build->add_option("dem", command->dem,
                    "Raster with heights, in any format that GDAL reads; several make a mosaic; or "
                    "synthetic:caldera?size=513&seed=1");
  build->add_option("-o,--out", command->out, "Folder to write to")->required();
  build->add_option("--tolerance", command->tolerance_m,
                    "Largest vertical distance of the finest level to any sample, in metres above "
                    "0; doubles with each coarser level [1]");
  build->add_option("--tile-cells", command->tile_cells,
                    "Cells along a tile of the finest level, 4 to 1024 [64]");
  build->add_option("--band", command->band, "Band with the heights, from 1 [the only one]");
  build->add_option("--nodata", command->nodata,
                    "Stored value that means no data, or none: all are heights [as the file says]");
  build->add_option("--vertical-unit", command->vertical_unit,
                    "Unit of the heights: metre, foot or us-survey-foot [as the file says, else "
                    "metre]");
  build->add_option("--crs", command->crs,
                    "Coordinate reference system, like EPSG:4326 [as the file says, else local "
                    "metres]");
  build->add_option("--jobs", command->jobs, "Threads; 0: one per core [0]");
  build->add_option("--config", command->config,
                    "TOML file with settings; options on the command line win");
  build->add_flag("--force", command->force,
                  "Write into a folder that holds files of somebody else");
  build->callback([command, &common] { run(*command, common); });
}

}  // namespace terrane::cli

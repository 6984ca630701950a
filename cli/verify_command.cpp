#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/build_settings.h"
#include "cli/commands.h"
#include "cli/terminal_progress.h"
#include "cli/unpacked_output.h"
#include "core/errors.h"
#include "ingest/read_polygon.h"
#include "ingest/scan.h"
#include "tiler/files/whole_file.h"
#include "tiler/verify/verify.h"
#include "tiler/verify/verify_pictures.h"
#include "tiler/verify/verify_terrain.h"
#include "tiler/verify/water_samples.h"

namespace terrane::cli {
namespace {

struct VerifyCommand {
  std::filesystem::path out;
  std::vector<std::string> dem;
  std::filesystem::path json;
  int jobs = 0;
};

void check_finished(const std::filesystem::path& out) {
  if (std::filesystem::exists(out / "terrane.json")) return;
  throw InputError(fmt::format(
      "{}: is no finished output of terrane, as terrane.json is missing. Run terrane build first",
      out.string()));
}

/// A tile set of another DEM would fail in a thousand places: say the one thing that is wrong.
void check_same_dem(const std::filesystem::path& out, const ingest::Dem& dem, Progress& progress) {
  const auto summary = nlohmann::json::parse(tiler::read_whole_file(out / "terrane.json"));
  const auto built_from = summary.at("dem").at("fingerprint").get<std::string>();
  if (ingest::scan_heights(dem, progress).fingerprint == built_from) return;
  throw InputError(
      fmt::format("{}: was not built from {}, or that has changed since. Name the right DEM with "
                  "--dem, or build "
                  "again",
                  out.string(), dem.name()));
}

/// A report of any kind of output.
struct Verdict {
  bool holds = false;
  std::string text, json;
};

template <class Report>
Verdict verdict_of(const Report& report) {
  return {report.holds(), to_text(report), to_json(report)};
}

/// The polygons as their files have them, read anew and not laid on any grid.
std::vector<verify::WaterArea> water_areas(const std::vector<std::string>& sources) {
  std::vector<verify::WaterArea> areas;
  for (const std::string& source : sources) {
    for (ingest::Polygon& polygon : ingest::read_layer_polygons(source).polygons) {
      verify::WaterArea& area = areas.emplace_back();
      area.shores = std::move(polygon.holes);
      area.shores.push_back(std::move(polygon.outline));
    }
  }
  return areas;
}

/// Is what the tiles are held against flat in water, and the DEM elsewhere?
verify::WaterFindings check_water(const BuildSettings& settings, const ingest::Dem& levelled,
                                  std::span<const verify::WaterArea> areas, Progress& progress) {
  if (areas.empty()) return {};
  const auto dem = ingest::open_dem(settings.dem, settings.ingest, progress);
  NoProgress quietly;
  raise_to_the_ellipsoid(*dem, settings.tiling, quietly);
  return verify::check_water(dem->heights(), levelled.heights(), dem->place(), areas,
                             settings.build.tolerance_m);
}

verify::VerifyReport verify_tiles(const std::filesystem::path& out, const BuildSettings& settings,
                                  const ingest::Dem& dem, int jobs, Progress& progress) {
  std::vector<verify::WaterArea> areas = water_areas(settings.features.water);
  const verify::WaterFindings found = check_water(settings, dem, areas, progress);
  for (std::size_t k = 0; k < areas.size(); ++k) areas[k].height_m = found.heights_m[k];
  const verify::VerifyOptions options{.jobs = jobs, .water = std::move(areas)};
  auto report = verify::verify(out, dem.heights(), dem.place(), options, progress);
  report.samples_under_water = found.under_water;
  report.water_samples_wrong = found.wrong;
  report.problems.insert(report.problems.end(), found.problems.begin(), found.problems.end());
  return report;
}

Verdict verify_folder(const std::filesystem::path& out, const VerifyCommand& command,
                      Progress& progress) {
  check_finished(out);
  BuildSettings settings;
  read_settings(out / "build.toml", settings);
  if (!command.dem.empty()) settings.dem = command.dem;
  const auto dem = ingest::open_dem(settings.dem, settings.ingest, progress);
  NoProgress quietly;  // what was assumed was said by the build
  if (!settings.tiling.is_geodetic()) {
    if (!settings.tiling.is_raster()) raise_to_the_ellipsoid(*dem, settings.tiling, quietly);
    read_features(settings, *dem, progress);
  }
  check_same_dem(out, *dem, progress);
  const verify::VerifyOptions options{.jobs = command.jobs};
  if (settings.tiling.is_raster()) {
    return verdict_of(verify::verify_pictures(out, dem->heights(), dem->place(),
                                              settings.tiling.fill_m, progress));
  }
  if (!settings.tiling.is_geodetic()) {
    return verdict_of(verify_tiles(out, settings, *dem, command.jobs, progress));
  }
  const auto geoid = geoid_of(*dem, settings.tiling, quietly);
  const verify::Undulation undulation = [&](const LonLat& place) {
    return geoid == nullptr ? 0 : geoid->undulation_m(place);
  };
  return verdict_of(
      verify::verify_terrain(out, dem->heights(), dem->place(), undulation, options, progress));
}

void run(const VerifyCommand& command, const CommonOptions& common) {
  const auto progress = make_progress(common.quiet);
  Verdict verdict;
  with_output_folder(command.out, *progress, [&](const std::filesystem::path& folder) {
    verdict = verify_folder(folder, command, *progress);
  });
  if (!command.json.empty()) tiler::write_whole_file(command.json, verdict.json);
  fmt::print("{}", verdict.text);
  if (!verdict.holds) throw AnswerIsNo();
}

}  // namespace

void add_verify_command(CLI::App& app, const CommonOptions& common) {
  auto command = std::make_shared<VerifyCommand>();
  CLI::App* verify = app.add_subcommand(
      "verify", "Check tiles against their DEM: error bound, folds, seams, blends, boxes");
  verify->add_option("out", command->out, "Folder that terrane build wrote, or its archive")
      ->required();
  verify->add_option("--dem", command->dem, "DEM to check against [the one it was built from]");
  verify->add_option("--json", command->json, "File to write the whole report to");
  verify->add_option("--jobs", command->jobs, "Threads; 0: one per core")->capture_default_str();
  verify->callback([command, &common] { run(*command, common); });
}

}  // namespace terrane::cli

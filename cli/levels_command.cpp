#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/level_export.h"
#include "cli/level_settings.h"
#include "cli/surface_input.h"
#include "cli/terminal_progress.h"
#include "core/errors.h"
#include "hierarchy/levels/build_levels.h"
#include "hierarchy/levels/level_error.h"
#include "hierarchy/levels/levels_file.h"
#include "hierarchy/levels/swap_cycles.h"
#include "tiler/files/whole_file.h"

namespace terrane::cli {
namespace {

using Clock = std::chrono::steady_clock;

struct LevelsCommand {
  SurfaceInput surface;
  std::filesystem::path out;
  double share = 0.03;
  std::string weights = "st-helens", stop = "level=30";
  bool is_published = false, swaps_cycles = false;
  std::filesystem::path report;
  int jobs = 0;
  ExportOptions exports;
};

/// How a level came about, and when.
struct TimedLevel {
  hierarchy::LevelStatistics statistics;
  double seconds = 0;
};

hierarchy::SurfaceMesh read_mesh(const LevelsCommand& command, Progress& progress) {
  hierarchy::SurfaceMesh mesh = read_input(command.surface, progress);
  if (command.swaps_cycles) {
    const hierarchy::CycleSwaps swaps = hierarchy::swap_cycles(mesh);
    progress.note(fmt::format("{}: {} of {} cycles removed by swapping an edge",
                              command.surface.input, swaps.removed, swaps.found));
  }
  return mesh;
}

/// Drops the coarsest levels whose largest error is above a limit.
void cut_at_error(hierarchy::LevelSequence& sequence, double limit, Progress& progress) {
  const hierarchy::LevelErrorMeter meter(sequence);
  hierarchy::LevelRebuilder rebuilder(sequence);
  progress.begin("measuring", sequence.level_count());
  while (rebuilder.level() > 0) {
    const auto error = meter.measure(rebuilder.mesh(), rebuilder.level());
    if ((error.vertical ? error.vertical->max : error.max) <= limit) break;
    rebuilder.refine();
    progress.advance(1);
  }
  sequence.coarsest_points = rebuilder.points();
  sequence.coarsest_triangles = rebuilder.triangles();
  sequence.levels.resize(rebuilder.level());
}

nlohmann::ordered_json error_json(const hierarchy::LevelError& error) {
  nlohmann::ordered_json json{{"max_error", error.max}, {"rms_error", error.rms}};
  if (error.vertical) {
    json["max_vertical_error"] = error.vertical->max;
    json["rms_vertical_error"] = error.vertical->rms;
    json["uncovered"] = error.vertical->uncovered;
    json["folded"] = error.vertical->folded;
  }
  return json;
}

nlohmann::ordered_json level_json(const TimedLevel& level, std::size_t finest,
                                  const hierarchy::LevelError& error) {
  nlohmann::ordered_json json{
      {"level", level.statistics.level},
      {"triangles", level.statistics.triangles},
      {"share", static_cast<double>(level.statistics.triangles) / static_cast<double>(finest)},
      {"collapses", level.statistics.collapses}};
  for (std::size_t i = 0; i < hierarchy::kRejectionCount; ++i) {
    json["rejected"][std::string(hierarchy::kRejectionNames[i])] = level.statistics.rejected[i];
  }
  json.update(error_json(error));
  json["seconds"] = level.seconds;
  return json;
}

void write_report(const LevelsCommand& command, const hierarchy::LevelSequence& sequence,
                  std::vector<TimedLevel> levels, Progress& progress) {
  const hierarchy::LevelErrorMeter meter(sequence);
  const std::size_t finest = meter.finest().triangles.size();
  levels.resize(sequence.level_count());
  levels.insert(levels.begin(), {.statistics = {.triangles = static_cast<std::uint32_t>(finest)}});

  hierarchy::LevelRebuilder rebuilder(sequence);
  progress.begin("measuring", sequence.level_count());
  auto array = nlohmann::ordered_json::array();
  for (;;) {
    const std::uint32_t level = rebuilder.level();
    array.insert(array.begin(),
                 level_json(levels[level], finest, meter.measure(rebuilder.mesh(), level)));
    if (level == 0) break;
    rebuilder.refine();
    progress.advance(1);
  }
  tiler::write_whole_file(
      command.report,
      nlohmann::ordered_json{{"input", command.surface.input}, {"levels", array}}.dump(1) + "\n");
}

hierarchy::LevelSequence build(const LevelsCommand& command, const hierarchy::SurfaceMesh& mesh,
                               std::vector<TimedLevel>& levels, Progress& progress) {
  const StopRule stop = stop_of(command.stop);
  hierarchy::LevelOptions options{
      .weights = weights_of(command.weights),
      .share = command.share,
      .rules = command.is_published ? hierarchy::Rules::kPublished : hierarchy::Rules::kTightened,
      .most_levels = stop.most_levels,
      .fewest_triangles = stop.fewest_triangles,
      .jobs = command.jobs};
  Clock::time_point before = Clock::now();
  options.keep = [&](const hierarchy::LevelStatistics& statistics) {
    const Clock::time_point now = Clock::now();
    levels.push_back({statistics, std::chrono::duration<double>(now - before).count()});
    before = now;
    progress.advance(1);
    return true;
  };
  progress.begin("levels", stop.most_levels == StopRule::kAllLevels ? 30 : stop.most_levels);
  hierarchy::LevelSequence sequence = hierarchy::build_levels(mesh, options);
  if (stop.most_error) cut_at_error(sequence, *stop.most_error, progress);
  return sequence;
}

void run(const LevelsCommand& command, const CommonOptions& common) {
  const auto progress = make_progress(common.quiet);
  if (is_levels_file(command.surface.input)) {
    export_levels(command.surface.input, command.exports, command.out);
    return;
  }
  if (is_given(command.exports)) {
    throw ConfigError(fmt::format(
        "{}: --extract and --every read a file of levels. Build one first: terrane levels {} -o "
        "NAME.levels",
        command.surface.input, command.surface.input));
  }
  const hierarchy::SurfaceMesh mesh = read_mesh(command, *progress);
  std::vector<TimedLevel> levels;
  const hierarchy::LevelSequence sequence = build(command, mesh, levels, *progress);
  const std::string bytes = hierarchy::encode_levels(sequence);
  if (!command.report.empty()) write_report(command, sequence, levels, *progress);
  tiler::write_whole_file(command.out, bytes);
  fmt::print("{}: {} levels, {} -> {} triangles, {:.2f} MB\n", command.out.string(),
             sequence.level_count(), mesh.triangles.size(), sequence.coarsest_triangles.size(),
             static_cast<double>(bytes.size()) / 1e6);
}

void add_export_options(CLI::App& levels, ExportOptions& exports) {
  levels.add_option("--extract", exports.extract,
                    "From a file of levels: write level i, or i:t for the blend of i into i + 1, t "
                    "in 0 to 1, as the mesh file OUT (.ply, .obj or .glb)");
  levels.add_option("--every", exports.every,
                    "From a file of levels: write every k-th level with its morph to the next one "
                    "written, into the folder OUT");
  levels.add_option("--format", exports.format, "Of --every: ply, obj or glb")
      ->capture_default_str();
}

}  // namespace

void add_levels_command(CLI::App& app, const CommonOptions& common) {
  auto command = std::make_shared<LevelsCommand>();
  CLI::App* levels = app.add_subcommand(
      "levels",
      "Build the published hierarchy of a triangle mesh or a DEM, or take levels from it");
  levels
      ->add_option("input", command->surface.input,
                   "Mesh (OBJ, PLY, OFF, STL), DEM, or a file NAME.levels written before")
      ->required();
  levels->add_option("-o,--out", command->out, "File of levels to write, or what was extracted")
      ->required();
  levels
      ->add_option("--share", command->share,
                   "Share of a level's triangles that collapse, above 0 to 1")
      ->capture_default_str();
  levels
      ->add_option("--weights", command->weights,
                   "st-helens (also saddle), crater-lake (also torus), or four numbers from 0 to "
                   "1: curvature,angle,valence,error")
      ->capture_default_str();
  levels
      ->add_option("--stop", command->stop,
                   "level=N, triangles=N, or error=E: the coarsest level within E of the input, in "
                   "its unit (metres for a DEM)")
      ->capture_default_str();
  levels->add_flag("--published", command->is_published,
                   "Keep to the published rules: borders may move, height fields may fold");
  levels->add_flag("--swap-cycles", command->swaps_cycles,
                   "Remove cycles (vertices of valence 3) from the mesh first by swapping edges");
  levels->add_option("--report", command->report,
                     "JSON file to write: triangles, rejections, errors and seconds of each level");
  levels->add_option("--jobs", command->jobs, "Threads; 0: one per core")->capture_default_str();
  add_surface_options(*levels, command->surface);
  add_export_options(*levels, command->exports);
  levels->callback([command, &common] { run(*command, common); });
}

}  // namespace terrane::cli

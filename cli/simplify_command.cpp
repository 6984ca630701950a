#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/dem_options.h"
#include "cli/terminal_progress.h"
#include "ingest/features.h"
#include "ingest/scan.h"
#include "tiler/dem_size.h"
#include "tiler/files/mesh_file.h"
#include "tiler/files/whole_file.h"
#include "tiler/simplify.h"

namespace terrane::cli {
namespace {

struct SimplifyCommand {
  DemOptions dem;
  std::filesystem::path out, report;
  tiler::SimplifyOptions options;
};

std::string report_of(const tiler::SimplifiedTerrain& terrain, const SimplifyCommand& command,
                      GridShape shape) {
  const nlohmann::ordered_json report{
      {"generator", "terrane " TERRANE_VERSION},
      {"columns", shape.columns},
      {"rows", shape.rows},
      {"tolerance_m", command.options.tolerance_m},
      {"input_triangles", terrain.input_triangles},
      {"triangles", terrain.mesh.triangles.size()},
      {"vertices", terrain.mesh.vertices.size()},
      {"samples", terrain.error.samples},
      {"max_error_m", terrain.error.max_m},
      {"rms_error_m", terrain.error.rms_m},
  };
  return report.dump(2) + "\n";
}

void run(const SimplifyCommand& command, const CommonOptions& common) {
  tiler::SimplifyOptions options = command.options;
  const tiler::MeshFormat format = tiler::mesh_format_of(command.out);
  options.height_steps_per_m = tiler::height_steps_per_m(format);
  tiler::check(options);
  ingest::OpenOptions open_options;
  apply(command.dem, open_options);
  const auto progress = make_progress(common.quiet);
  const auto dem = ingest::open_dem(command.dem.dem, open_options, *progress);
  tiler::check_size(dem->heights().shape());
  ingest::FeatureOptions features{.plan_tolerance_m = options.tolerance_m};
  apply(command.dem, features);
  options.features = ingest::read_features(*dem, features, *progress);
  ingest::scan_heights(*dem, *progress);  // refuses voids that pass for heights

  const GridShape shape = dem->heights().shape();
  const auto terrain = tiler::simplify(dem->heights(), options, *progress);
  tiler::write_whole_file(command.out,
                          tiler::encode_mesh(terrain.mesh, format, dem->place(), shape));
  if (!command.report.empty()) {
    tiler::write_whole_file(command.report, report_of(terrain, command, shape));
  }
  fmt::print("{}: {} of {} triangles, at most {:.3f} m off, rms {:.3f} m\n", command.out.string(),
             terrain.mesh.triangles.size(), terrain.input_triangles, terrain.error.max_m,
             terrain.error.rms_m);
}

}  // namespace

void add_simplify_command(CLI::App& app, const CommonOptions& common) {
  auto command = std::make_shared<SimplifyCommand>();
  CLI::App* simplify =
      app.add_subcommand("simplify", "Turn a DEM into one mesh with few triangles, without tiles");
  add_dem_options(*simplify, command->dem)->required();
  add_feature_options(*simplify, command->dem);
  simplify
      ->add_option("-o,--out", command->out,
                   "Mesh to write: .obj or .ply in the DEM's CRS, .glb in local metres")
      ->required();
  simplify
      ->add_option("--tolerance", command->options.tolerance_m,
                   "Largest vertical distance to any sample, in metres above 0")
      ->capture_default_str();
  simplify
      ->add_option("--effort", command->options.effort,
                   "0 to 3: more time for fewer triangles within the same tolerance")
      ->capture_default_str();
  simplify->add_option("--report", command->report,
                       "File to write counts and measured errors to, as JSON");
  simplify->callback([command, &common] { run(*command, common); });
}

}  // namespace terrane::cli

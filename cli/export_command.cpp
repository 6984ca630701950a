#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "cli/commands.h"
#include "cli/terminal_progress.h"
#include "cli/unpacked_output.h"
#include "core/errors.h"
#include "tiler/files/mesh_file.h"
#include "tiler/files/whole_file.h"
#include "tiler/welded/encode_surface.h"

namespace terrane::cli {
namespace {

namespace fs = std::filesystem;

struct ExportCommand {
  fs::path out;
  fs::path file;
  int level = 0;
  std::vector<double> area;  ///< none, or west, south, east, north
  bool stack = false;
};

std::optional<welded::Area> area_of(const ExportCommand& command) {
  if (command.area.empty()) return std::nullopt;
  return welded::Area{command.area[0], command.area[1], command.area[2], command.area[3]};
}

std::string encode(const welded::LevelMesh& mesh, tiler::MeshFormat format) {
  switch (format) {
    case tiler::MeshFormat::kObj:
      return welded::encode_obj(mesh);
    case tiler::MeshFormat::kPly:
      return welded::encode_ply(mesh);
    case tiler::MeshFormat::kGlb:
      return welded::encode_glb({mesh});
  }
  return {};
}

void report(const fs::path& file, const welded::LevelMesh& mesh) {
  fmt::print("{}: level {}, {} triangles, {} vertices, at most {:.3f} m off\n", file.string(),
             mesh.level, mesh.surface.triangles.size(), mesh.surface.positions.size(),
             mesh.max_error_m);
}

void export_level(const ExportCommand& command, const fs::path& folder) {
  const tiler::MeshFormat format = tiler::mesh_format_of(command.file);
  const welded::LevelMesh mesh = welded::weld_level(folder, command.level, area_of(command));
  tiler::write_whole_file(command.file, encode(mesh, format));
  report(command.file, mesh);
}

void export_as_one_glb(const ExportCommand& command, const fs::path& folder) {
  if (tiler::mesh_format_of(command.file) != tiler::MeshFormat::kGlb) {
    throw ConfigError(fmt::format("{}: a stack is one .glb, or a folder. Use another name",
                                  command.file.string()));
  }
  std::vector<welded::LevelMesh> levels;
  for (int level = command.level; level < welded::level_count(folder); ++level) {
    levels.push_back(welded::weld_level(folder, level, area_of(command)));
  }
  tiler::write_whole_file(command.file, welded::encode_glb(levels));
  for (const welded::LevelMesh& mesh : levels) report(command.file, mesh);
}

void export_as_folder(const ExportCommand& command, const fs::path& folder) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (int level = command.level; level < welded::level_count(folder); ++level) {
    const welded::LevelMesh mesh = welded::weld_level(folder, level, area_of(command));
    const std::string name = fmt::format("level_{}.glb", level);
    tiler::write_whole_file(command.file / name, welded::encode_glb({mesh}));
    report(command.file / name, mesh);
    list.push_back({{"file", name},
                    {"level", level},
                    {"tolerance_m", mesh.tolerance_m},
                    {"max_error_m", mesh.max_error_m},
                    {"triangles", mesh.surface.triangles.size()}});
  }
  tiler::write_whole_file(command.file / "stack.json",
                          nlohmann::ordered_json{{"levels", list}}.dump(1) + "\n");
}

void run(const ExportCommand& command, const CommonOptions& common) {
  const auto progress = make_progress(common.quiet);
  with_output_folder(command.out, *progress, [&](const fs::path& folder) {
    if (!command.stack) return export_level(command, folder);
    if (command.file.has_extension()) return export_as_one_glb(command, folder);
    export_as_folder(command, folder);
  });
}

}  // namespace

void add_export_command(CLI::App& app, const CommonOptions& common) {
  auto command = std::make_shared<ExportCommand>();
  CLI::App* exporting = app.add_subcommand(
      "export", "Join the tiles of a level into one mesh, for engines and tools");
  exporting->add_option("out", command->out, "Folder that terrane build wrote, or its archive")
      ->required();
  exporting
      ->add_option("-o,--mesh", command->file,
                   "File to write: .glb, .obj or .ply; with --stack a .glb or a folder")
      ->required();
  exporting->add_option("--level", command->level, "Level; 0 is the finest")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  exporting
      ->add_option(
          "--area", command->area,
          "Only this part: west,south,east,north in degrees, or in metres of a DEM without "
          "CRS")
      ->delimiter(',')
      ->expected(4);
  exporting->add_flag("--stack", command->stack,
                      "All levels from --level on: one glb with MSFT_lod, or a folder of glbs");
  exporting->callback([command, &common] { run(*command, common); });
}

}  // namespace terrane::cli

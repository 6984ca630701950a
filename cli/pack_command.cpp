#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>

#include "archive/pack.h"
#include "cli/commands.h"
#include "cli/terminal_progress.h"
#include "viewer/server/viewer_files.h"

namespace terrane::cli {
namespace {

namespace fs = std::filesystem;

struct PackCommand {
  fs::path from;
  fs::path to;
};

/// `serve` and the hosted viewer bring their own.
std::set<std::string> names_of_viewer() {
  std::set<std::string> names;
  for (const viewer::ViewerFile& file : viewer::viewer_files()) names.emplace(file.path);
  return names;
}

void run_pack(const PackCommand& command, const CommonOptions& common) {
  archive::pack(command.from, command.to, names_of_viewer(), *make_progress(common.quiet));
  const auto packed = archive::open_archive(command.to);
  fmt::print("{}: {}, {} files, {:.2f} MB\n", command.to.string(), packed->facts().format,
             packed->facts().files, static_cast<double>(packed->file().bytes()) / 1e6);
}

void run_unpack(const PackCommand& command, const CommonOptions& common) {
  const auto packed = archive::open_archive(command.from);
  archive::unpack(*packed, command.to, *make_progress(common.quiet));
  fmt::print("{}: {} files\n", command.to.string(), packed->facts().files);
}

}  // namespace

void add_pack_command(CLI::App& app, const CommonOptions& common) {
  auto command = std::make_shared<PackCommand>();
  CLI::App* pack = app.add_subcommand("pack", "Pack an output folder into one file for a web host");
  pack->add_option("out", command->from, "Folder that terrane build wrote")->required();
  pack->add_option("-o,--archive", command->to,
                   "File to write: .pmtiles (range requests) or .3tz (3D Tiles archive)")
      ->required();
  pack->callback([command, &common] { run_pack(*command, common); });
}

void add_unpack_command(CLI::App& app, const CommonOptions& common) {
  auto command = std::make_shared<PackCommand>();
  CLI::App* unpack = app.add_subcommand("unpack", "Write the files of an archive into a folder");
  unpack->add_option("archive", command->from, ".pmtiles or .3tz that terrane pack wrote")
      ->required();
  unpack->add_option("-o,--out", command->to, "Folder to write to; empty or not yet there")
      ->required();
  unpack->callback([command, &common] { run_unpack(*command, common); });
}

}  // namespace terrane::cli

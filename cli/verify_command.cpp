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
#include "ingest/scan.h"
#include "tiler/files/whole_file.h"
#include "tiler/verify/verify.h"

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
  if (summary.at("format") == "terrane-geodetic/1") {
    throw InputError(fmt::format(
        "{}: holds terrain of --scheme geodetic, which verify does not judge. Its errors are in "
        "terrane.json: see terrane info",
        out.string()));
  }
  const auto built_from = summary.at("dem").at("fingerprint").get<std::string>();
  if (ingest::scan_heights(dem, progress).fingerprint == built_from) return;
  throw InputError(
      fmt::format("{}: was not built from {}, or that has changed since. Name the right DEM with "
                  "--dem, or build "
                  "again",
                  out.string(), dem.name()));
}

verify::VerifyReport verify_folder(const std::filesystem::path& out, const VerifyCommand& command,
                                   Progress& progress) {
  check_finished(out);
  BuildSettings settings;
  read_settings(out / "build.toml", settings);
  if (!command.dem.empty()) settings.dem = command.dem;
  const auto dem = ingest::open_dem(settings.dem, settings.ingest, progress);
  read_features(settings, *dem, progress);
  check_same_dem(out, *dem, progress);
  return verify::verify(out, dem->heights(), dem->place(), {.jobs = command.jobs}, progress);
}

void run(const VerifyCommand& command, const CommonOptions& common) {
  const auto progress = make_progress(common.quiet);
  verify::VerifyReport report;
  with_output_folder(command.out, *progress, [&](const std::filesystem::path& folder) {
    report = verify_folder(folder, command, *progress);
  });
  if (!command.json.empty()) tiler::write_whole_file(command.json, to_json(report));
  fmt::print("{}", to_text(report));
  if (!report.holds()) throw AnswerIsNo();
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

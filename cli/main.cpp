#include <fmt/format.h>

#include <cstdio>

#include "cli/commands.h"
#include "core/errors.h"
#include "core/freed_memory.h"

namespace {

constexpr const char* kFooter =
    "Exit status: 0 done; 1 verify found something that does not hold; 2 wrong arguments or\n"
    "settings; 3 input cannot be used; 4 mesh cannot be used; 5 output cannot be written;\n"
    "70 a defect of terrane.\n"
    "Results go to standard output, progress and errors to standard error.";
constexpr int kUsage = 2;
constexpr int kDefect = 70;

void describe(CLI::App& app, terrane::cli::CommonOptions& common) {
  app.set_version_flag("--version", "terrane " TERRANE_VERSION);
  app.add_flag("--quiet", common.quiet, "Say nothing but results and errors");
  app.footer(kFooter);
  app.require_subcommand(1);
  app.fallthrough();
  terrane::cli::add_build_command(app, common);
  terrane::cli::add_simplify_command(app, common);
  terrane::cli::add_info_command(app, common);
  terrane::cli::add_export_command(app, common);
  terrane::cli::add_levels_command(app, common);
  terrane::cli::add_merge_tree_command(app, common);
  terrane::cli::add_view_cut_command(app, common);
  terrane::cli::add_verify_command(app, common);
  terrane::cli::add_serve_command(app, common);
  terrane::cli::add_pack_command(app, common);
  terrane::cli::add_unpack_command(app, common);
  terrane::cli::add_volume_command(app, common);
}

}  // namespace

int main(int argc, char** argv) {
  terrane::keep_freed_memory();
  CLI::App app("Digital elevation models as sutured, bounded-error levels of detail", "terrane");
  terrane::cli::CommonOptions common;
  describe(app, common);
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsage;
  } catch (const terrane::cli::AnswerIsNo&) {
    return 1;
  } catch (const terrane::Error& error) {
    fmt::print(stderr, "terrane: {}\n", error.what());
    return error.exit_status();
  } catch (const std::exception& error) {
    fmt::print(stderr, "terrane: {} (a defect of terrane; please report it)\n", error.what());
    return kDefect;
  }
}

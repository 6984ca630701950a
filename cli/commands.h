#pragma once

#include <CLI/CLI.hpp>

namespace terrane::cli {

/// What holds for every subcommand.
struct CommonOptions {
  bool quiet = false;  ///< nothing on stderr but errors
};

// Each adds a subcommand that runs as soon as the command line is read, and throws terrane::Error.
void add_build_command(CLI::App& app, const CommonOptions& common);
void add_simplify_command(CLI::App& app, const CommonOptions& common);
void add_export_command(CLI::App& app, const CommonOptions& common);
void add_info_command(CLI::App& app, const CommonOptions& common);
void add_levels_command(CLI::App& app, const CommonOptions& common);
void add_pack_command(CLI::App& app, const CommonOptions& common);
void add_unpack_command(CLI::App& app, const CommonOptions& common);
void add_merge_tree_command(CLI::App& app, const CommonOptions& common);
void add_view_cut_command(CLI::App& app, const CommonOptions& common);
void add_verify_command(CLI::App& app, const CommonOptions& common);
void add_serve_command(CLI::App& app, const CommonOptions& common);
void add_volume_command(CLI::App& app, const CommonOptions& common);

/// Thrown by a command whose answer is "no" (verify): exit status 1, nothing more to say.
struct AnswerIsNo {};

}  // namespace terrane::cli

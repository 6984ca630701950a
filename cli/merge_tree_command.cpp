#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>

#include "cli/commands.h"
#include "cli/level_export.h"
#include "cli/surface_input.h"
#include "cli/terminal_progress.h"
#include "hierarchy/levels/levels_file.h"
#include "hierarchy/merge/build_merge_tree.h"
#include "hierarchy/merge/tree_file.h"
#include "tiler/files/whole_file.h"

namespace terrane::cli {
namespace {

struct MergeTreeCommand {
  SurfaceInput surface;
  std::filesystem::path out;
  hierarchy::MergeTreeOptions options;
};

hierarchy::MergeTree build(const MergeTreeCommand& command, Progress& progress) {
  const std::string& input = command.surface.input;
  if (is_levels_file(input)) {
    return hierarchy::merge_tree_of(hierarchy::decode_levels(tiler::read_whole_file(input), input));
  }
  const hierarchy::SurfaceMesh mesh = read_input(command.surface, progress);
  hierarchy::MergeTreeOptions options = command.options;
  options.passed = [&](const hierarchy::PassStatistics&) { progress.advance(1); };
  progress.begin("merging", 40);
  return hierarchy::build_merge_tree(mesh, options);
}

void run(const MergeTreeCommand& command, const CommonOptions& common) {
  const auto progress = make_progress(common.quiet);
  const hierarchy::MergeTree tree = build(command, *progress);
  const std::string bytes = hierarchy::encode_tree(tree);
  tiler::write_whole_file(command.out, bytes);
  fmt::print("{}: {} levels, {} -> {} triangles, {} -> {} vertices, {:.2f} MB\n",
             command.out.string(), tree.level_count(), tree.full_triangle_count(),
             tree.coarsest_triangles, tree.full_point_count(), tree.coarsest_points,
             static_cast<double>(bytes.size()) / 1e6);
}

}  // namespace

void add_merge_tree_command(CLI::App& app, const CommonOptions& common) {
  auto command = std::make_shared<MergeTreeCommand>();
  CLI::App* tree = app.add_subcommand(
      "merge-tree", "Build the merge tree of a triangle mesh or a DEM, for view-cut");
  tree->add_option("input", command->surface.input,
                   "Mesh (OBJ, PLY, OFF, STL), DEM, or a file NAME.levels of triangle collapses")
      ->required();
  tree->add_option("-o,--out", command->out, "Tree to write")->required();
  tree->add_option("--order", command->options.order,
                   "Which edges collapse first: those that leave the smallest error, or the "
                   "shortest")
      ->transform(CLI::CheckedTransformer(std::map<std::string, hierarchy::CollapseOrder>{
          {"error", hierarchy::CollapseOrder::kError},
          {"length", hierarchy::CollapseOrder::kLength}}))
      ->default_str("error");
  tree->add_option("--region", command->options.region,
                   "Triangles that a collapse needs unchanged: those at the removed end, or at "
                   "both ends (published)")
      ->transform(CLI::CheckedTransformer(std::map<std::string, hierarchy::Region>{
          {"removed", hierarchy::Region::kRemovedEnd}, {"both", hierarchy::Region::kBothEnds}}))
      ->default_str("removed");
  tree->add_option("--share", command->options.share,
                   "Share of the vertices that could go, cheapest first, that a pass looks at; "
                   "above 0 to 1")
      ->capture_default_str();
  tree->add_option("--fewest-vertices", command->options.fewest_vertices,
                   "The pass that comes to so many is the last")
      ->capture_default_str();
  tree->add_option("--smallest-quality", command->options.smallest_quality,
                   "Refuse triangles of a quality below this, 0 to 1 (equilateral)")
      ->capture_default_str();
  add_surface_options(*tree, command->surface);
  tree->callback([command, &common] { run(*command, common); });
}

}  // namespace terrane::cli

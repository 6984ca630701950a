#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands.h"
#include "core/errors.h"
#include "hierarchy/levels/write_surface.h"
#include "hierarchy/merge/merge_front.h"
#include "hierarchy/merge/tree_file.h"
#include "hierarchy/merge/triangle_budget.h"
#include "tiler/files/whole_file.h"
#include "tiler/gltf/write_morphing_glb.h"

namespace terrane::cli {
namespace {

using hierarchy::Camera;
using hierarchy::MergeFront;
using hierarchy::MergeTree;

struct ViewCutCommand {
  std::filesystem::path tree, out, report;
  std::vector<double> eye, target, up{0, 0, 1}, light;
  double fov_deg = 45;
  std::vector<double> size_px{1280, 720};
  std::optional<std::uint32_t> budget;
  bool is_switch_distance = false;
  hierarchy::ViewCriteria criteria;
};

/// What was shown, and what it took.
struct Cut {
  std::uint32_t triangles = 0, vertices = 0;
  double tolerance_px = 0, milliseconds = 0;
  hierarchy::UpdateStatistics update;
};

Eigen::Vector3d vector_of(const std::vector<double>& xyz) { return {xyz[0], xyz[1], xyz[2]}; }

Camera camera_of(const ViewCutCommand& command, const MergeTree& tree) {
  if (!(command.fov_deg > 0 && command.fov_deg < 180)) {
    throw ConfigError(fmt::format("--fov {}: has to be above 0 and below 180", command.fov_deg));
  }
  if (!(command.size_px[0] >= 1 && command.size_px[1] >= 1)) {
    throw ConfigError("--size: a picture is 1 pixel wide and high at least");
  }
  const auto [middle, reach] = extent_of(tree);
  const Eigen::Vector3d& origin = tree.lattice.origin();
  const Eigen::Vector3d target =
      command.target.empty() ? middle : Eigen::Vector3d(vector_of(command.target) - origin);
  const Eigen::Vector3d eye = command.eye.empty()
                                  ? Eigen::Vector3d(target + reach * Eigen::Vector3d(0, -2, 1))
                                  : Eigen::Vector3d(vector_of(command.eye) - origin);
  Camera camera = Camera::looking_at(eye, target, vector_of(command.up));
  camera.vertical_fov_deg = command.fov_deg;
  camera.width_px = command.size_px[0];
  camera.height_px = command.size_px[1];
  return camera;
}

hierarchy::ViewCriteria criteria_of(const ViewCutCommand& command) {
  hierarchy::ViewCriteria criteria = command.criteria;
  if (command.is_switch_distance) criteria.measure = hierarchy::ScreenMeasure::kSwitchDistance;
  if (!command.light.empty()) {
    const Eigen::Vector3d light = vector_of(command.light);
    if (!(light.norm() > 0)) throw ConfigError("--light 0,0,0: is no direction");
    criteria.to_light = light.normalized();
  }
  return criteria;
}

Cut cut(const ViewCutCommand& command, const MergeTree& tree, MergeFront& front) {
  const Camera camera = camera_of(command, tree);
  const hierarchy::ViewCriteria criteria = criteria_of(command);
  const auto before = std::chrono::steady_clock::now();
  Cut result{.tolerance_px = criteria.tolerance_px};
  if (command.budget) {
    result.tolerance_px = settle_on(*command.budget, tree, camera, criteria, front);
  } else {
    result.update = front.update(hierarchy::ViewJudge(tree, camera, criteria));
  }
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - before;
  result.milliseconds = took.count();
  result.triangles = front.display().triangle_count();
  result.vertices = front.display().vertex_count();
  return result;
}

/// The mesh that shows, its vertices numbered as they come.
hierarchy::SurfaceMesh mesh_shown(const MergeTree& tree, const MergeFront& front) {
  hierarchy::SurfaceMesh mesh;
  std::vector<std::uint32_t> number(tree.points.size(), ~std::uint32_t{0});
  for (const std::uint32_t t : front.display().shown()) {
    hierarchy::Corners corners = tree.triangles[t];
    for (std::uint32_t& v : corners) {
      if (number[v] == ~std::uint32_t{0}) {
        number[v] = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.push_back(tree.lattice.origin() + tree.lattice.relative(tree.points[v]));
        if (!tree.colours.empty()) mesh.colours.push_back(tree.colours[v]);
      }
      v = number[v];
    }
    mesh.triangles.push_back(corners);
  }
  return mesh;
}

std::string encode(const hierarchy::SurfaceMesh& mesh, const std::filesystem::path& out) {
  const std::string extension = out.extension().string();
  if (extension == ".ply") return hierarchy::encode_ply(mesh);
  if (extension == ".obj") return hierarchy::encode_obj(mesh);
  if (extension == ".glb") return tiler::encode_morphing_glb(mesh.points, {}, mesh.triangles);
  throw ConfigError(
      fmt::format("{}: is no name of a mesh to write. Use .ply, .obj or .glb", out.string()));
}

void write_report(const ViewCutCommand& command, const MergeTree& tree, const Cut& cut) {
  tiler::write_whole_file(command.report,
                          nlohmann::ordered_json{{"tree", command.tree.string()},
                                                 {"full_triangles", tree.full_triangle_count()},
                                                 {"coarsest_triangles", tree.coarsest_triangles},
                                                 {"levels", tree.level_count()},
                                                 {"triangles", cut.triangles},
                                                 {"vertices", cut.vertices},
                                                 {"tolerance_px", cut.tolerance_px},
                                                 {"splits", cut.update.splits},
                                                 {"looked_at", cut.update.looked_at},
                                                 {"milliseconds", cut.milliseconds}}
                                  .dump(1) +
                              "\n");
}

void run(const ViewCutCommand& command) {
  const MergeTree tree =
      hierarchy::decode_tree(tiler::read_whole_file(command.tree), command.tree.string());
  MergeFront front(tree);
  const Cut result = cut(command, tree, front);
  tiler::write_whole_file(command.out, encode(mesh_shown(tree, front), command.out));
  if (!command.report.empty()) write_report(command, tree, result);
  fmt::print("{}: {} of {} triangles, {} vertices, {:.3g} px, {:.2f} ms from the coarsest mesh\n",
             command.out.string(), result.triangles, tree.full_triangle_count(), result.vertices,
             result.tolerance_px, result.milliseconds);
}

void add_criteria(CLI::App& cut, ViewCutCommand& command) {
  cut.add_option("--pixels", command.criteria.tolerance_px, "Error tolerated on the screen")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  cut.add_flag("--switch-distance", command.is_switch_distance,
               "Measure how long the collapsed edges look (published) and not the error");
  cut.add_option("--budget", command.budget,
                 "Show the finest mesh of at most so many triangles; --pixels and the others keep "
                 "their ratios")
      ->check(CLI::PositiveNumber);
  cut.add_flag("--frustum", command.criteria.frustum, "Nothing is wanted outside the picture");
  cut.add_flag("--back-faces", command.criteria.back_faces, "Nothing is wanted that faces away");
  cut.add_option("--silhouette", command.criteria.silhouette_px,
                 "Error tolerated where a silhouette may be")
      ->check(CLI::NonNegativeNumber);
  cut.add_option("--highlight", command.criteria.highlight_px,
                 "Length of edges tolerated where the highlight varies")
      ->check(CLI::NonNegativeNumber);
  cut.add_option("--colour", command.criteria.colour_px,
                 "Length of edges tolerated where the colours of the vertices vary")
      ->check(CLI::NonNegativeNumber);
  cut.add_option("--light", command.light, "Direction to the light: x,y,z")
      ->delimiter(',')
      ->expected(3);
  cut.add_option("--shininess", command.criteria.shininess, "Exponent of the highlight")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
}

}  // namespace

void add_view_cut_command(CLI::App& app, const CommonOptions&) {
  auto command = std::make_shared<ViewCutCommand>();
  CLI::App* cut = app.add_subcommand(
      "view-cut", "Write the mesh that a merge tree shows to a camera, fine where it looks");
  cut->add_option("tree", command->tree, "Tree that merge-tree wrote")->required();
  cut->add_option("-o,--out", command->out, "Mesh to write: .ply, .obj or .glb")->required();
  cut->add_option("--camera", command->eye,
                  "Where the camera is: x,y,z in the frame of the mesh (of a DEM: metres from its "
                  "first sample, x along a row, y up the columns); without, south and above")
      ->delimiter(',')
      ->expected(3);
  cut->add_option("--target", command->target, "What it looks at: x,y,z; without, the middle")
      ->delimiter(',')
      ->expected(3);
  cut->add_option("--up", command->up, "Upwards: x,y,z")
      ->delimiter(',')
      ->expected(3)
      ->capture_default_str();
  cut->add_option("--fov", command->fov_deg, "Vertical angle of view in degrees")
      ->capture_default_str();
  cut->add_option("--size", command->size_px, "Of the picture in pixels: width,height")
      ->delimiter(',')
      ->expected(2)
      ->capture_default_str();
  add_criteria(*cut, *command);
  cut->add_option("--report", command->report, "JSON file to write: counts and times");
  cut->callback([command] { run(*command); });
}

}  // namespace terrane::cli

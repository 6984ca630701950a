// The experiment of Gregorski et al. 2003, section 8, on a stand-in for their data set: the table
// and the pictures of docs/papers.md.
//
//   build/bench/bin/terrane_impact FOLDER_FOR_PICTURES
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "model/section_svg.h"
#include "tests/hierarchy/volume/impact_model.h"
#include "tiler/files/whole_file.h"

namespace terrane::hierarchy::volume {
namespace {

using testing::ImpactModel;
constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kInterfaceTolerance = 0.15, kDensityTolerance = 3;

void count_triangles(const VolumeModel& model) {
  std::array<int, 3> counts = {};  // block and empty, projectile and empty, projectile and block
  const auto& projectile = *model.interfaces[0];
  const auto& block = *model.interfaces[1];
  const auto centre = [](const auto& c) -> Eigen::Vector3d { return (c[0] + c[1] + c[2]) / 3; };
  const auto is_in_box = [&](const Eigen::Vector3d& p) {
    return (p.array() >= model.box.low.array()).all() &&
           (p.array() <= model.box.high.array()).all();
  };
  for (std::uint32_t t = 0; t < block.mesh().triangles.size(); ++t) {
    const Eigen::Vector3d p = centre(block.corners(t));
    if (is_in_box(p) && projectile.signed_distance(p, DistanceRule::kExact) > 0) ++counts[0];
  }
  for (std::uint32_t t = 0; t < projectile.mesh().triangles.size(); ++t) {
    const Eigen::Vector3d p = centre(projectile.corners(t));
    if (is_in_box(p)) ++counts[block.signed_distance(p, DistanceRule::kExact) > 0 ? 1 : 2];
  }
  fmt::print(
      "triangles in the box: block and empty {}, projectile and empty {}, projectile and "
      "block {}\n",
      counts[0], counts[1], counts[2]);
}

struct FieldErrors {
  double largest = 0, mean = 0;
  std::size_t posts = 0;
};

// over the grid's posts in cells with interfaces, each in its true material
FieldErrors errors_at_posts(const MaterialVolume& volume) {
  FieldErrors errors;
  const auto axes = ImpactModel::posts();
  for (const double z : axes[2]) {
    for (const double y : axes[1]) {
      for (const double x : axes[0]) {
        const Eigen::Vector3d p(x, y, z);
        const auto [leaf, weights] = volume.mesh().locate(p);
        if (volume.interfaces_in(leaf) == 0) continue;
        const MaterialId material = volume.true_material(p);
        const double error = std::abs(weights.dot(volume.values(leaf, FieldId{0}, material)) -
                                      volume.model().fields[0].field->value(p, material));
        errors.largest = std::max(errors.largest, error);
        errors.mean += error;
        ++errors.posts;
      }
    }
  }
  if (errors.posts > 0) errors.mean /= static_cast<double>(errors.posts);
  return errors;
}

std::size_t cells_with_interfaces(const MaterialVolume& volume) {
  std::size_t count = 0;
  volume.mesh().for_each_leaf([&](CellId leaf) { count += volume.interfaces_in(leaf) != 0; });
  return count;
}

void draw(const MaterialVolume& volume, const std::filesystem::path& file, int field,
          bool shows_mesh) {
  if (file.parent_path().empty()) return;
  model::SectionPicture picture;
  picture.plane = {Eigen::Vector3d(0, 1, 0), 0.37};
  picture.field = field;
  picture.lowest = 0;
  picture.highest = 130;
  picture.shows_mesh = shows_mesh;
  picture.width_px = 700;
  tiler::write_whole_file(file, model::section_svg(volume, picture));
}

void run_with_interfaces(const char* name, const VolumeOptions& options, DeviationRule rule,
                         const std::filesystem::path& folder) {
  MaterialVolume volume(ImpactModel{}.model(rule), options);
  volume.refine({{kInterfaceTolerance, kInterfaceTolerance}, {kNone}});
  fmt::print("{}: interfaces {} of {} cells", name, cells_with_interfaces(volume),
             volume.mesh().leaf_count());
  volume.refine({{kInterfaceTolerance, kInterfaceTolerance}, {kDensityTolerance}});
  const FieldErrors errors = errors_at_posts(volume);
  fmt::print(
      ", and density {} cells; error at {} posts in cells with interfaces {:.3f}, mean "
      "{:.4f}\n",
      volume.mesh().leaf_count(), errors.posts, errors.largest, errors.mean);
  draw(volume, folder / fmt::format("{}_density.svg", name), 0, false);
  draw(volume, folder / fmt::format("{}_mesh.svg", name), 0, true);
}

void run_without_interfaces(const std::filesystem::path& folder) {
  MaterialVolume volume(ImpactModel{}.model_without_interfaces(DeviationRule::kNativePoints));
  const bool equal_cells = volume.refine({{}, {kDensityTolerance}}, 12'000);
  fmt::print("linear across the jump, {} cells: within {}: {}\n", volume.mesh().leaf_count(),
             kDensityTolerance, equal_cells);
  draw(volume, folder / "linear_density.svg", 0, false);
  draw(volume, folder / "linear_mesh.svg", 0, true);
  const bool is_within = volume.refine({{}, {kDensityTolerance}}, 3'000'000);
  double largest = 0;
  volume.mesh().for_each_leaf(
      [&](CellId leaf) { largest = std::max(largest, volume.field_error(leaf, FieldId{0})); });
  fmt::print("linear across the jump, to the same density error: {} cells ({}), error {:.3f}\n",
             volume.mesh().leaf_count(), is_within ? "reached" : "stopped", largest);
}

}  // namespace
}  // namespace terrane::hierarchy::volume

int main(int argc, char** argv) {
  using namespace terrane::hierarchy::volume;
  const std::filesystem::path folder = argc > 1 ? argv[1] : "";
  count_triangles(ImpactModel{}.model(DeviationRule::kNativePoints));
  run_with_interfaces("published", {DistanceRule::kNearestVertex, InterfaceErrorRule::kVertices},
                      DeviationRule::kNativePoints, folder);
  run_with_interfaces("exact_distance", {DistanceRule::kExact, InterfaceErrorRule::kVertices},
                      DeviationRule::kNativePoints, folder);
  run_with_interfaces("strict", {DistanceRule::kExact, InterfaceErrorRule::kStrict},
                      DeviationRule::kEverywhere, folder);
  run_without_interfaces(folder);
  return 0;
}

// What a frame of a merge tree costs: how it grows with what changes, and with the model.
// terrane_frames: hills of 10,000 to 3 million triangles. terrane_frames FILE.tree TRIANGLES: that
// tree, seen from all around in steps of 1 degree, coarse behind and fine along silhouettes.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include "hierarchy/merge/build_merge_tree.h"
#include "hierarchy/merge/merge_front.h"
#include "hierarchy/merge/tree_file.h"
#include "hierarchy/merge/triangle_budget.h"

namespace terrane::hierarchy {
namespace {

/// Processor time, in seconds: what others do on the machine does not count.
double now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Hills with detail at every scale: side x side samples over [-1, 1]^2.
SurfaceMesh hills(std::uint32_t side) {
  SurfaceMesh mesh;
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i) {
      const double x = 2.0 * i / (side - 1) - 1, y = 2.0 * j / (side - 1) - 1;
      double z = 0;
      for (int octave = 0; octave < 9; ++octave) {
        const double f = std::exp2(octave);
        z += 0.12 / f * std::sin(f * (2.3 * x + 1.1 * y) + octave) *
             std::cos(f * (1.9 * y - 0.7 * x) + 2 * octave);
      }
      mesh.points.push_back({x, y, z});
    }
  }
  for (std::uint32_t j = 0; j + 1 < side; ++j) {
    for (std::uint32_t i = 0; i + 1 < side; ++i) {
      const std::uint32_t a = j * side + i, b = a + 1, c = a + side + 1, d = a + side;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

/// Round the middle at a distance, looking at it.
Camera orbit(const MergeTree& tree, double degrees) {
  const Eigen::Vector3d middle = -tree.lattice.origin();
  const double u = degrees * std::numbers::pi / 180;
  return Camera::looking_at(middle + Eigen::Vector3d(1.6 * std::cos(u), 1.6 * std::sin(u), 0.9),
                            middle);
}

/// The tree shows about so many triangles; frames of steps of several sizes, a line each.
void measure_frames(const MergeTree& tree, std::uint32_t triangles) {
  MergeFront front(tree);
  const double tolerance_px = settle_on(triangles, tree, orbit(tree, 0), {}, front);
  for (const double step : {0.0, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0}) {
    std::vector<double> seconds;
    double changes = 0, looked_at = 0, shown = 0;
    constexpr int kFrames = 40;
    double at = 0;
    front.update(ViewJudge(tree, orbit(tree, at), {.tolerance_px = tolerance_px}));
    for (int frame = 0; frame < kFrames; ++frame) {
      front.display().forget_changes();
      at += step;
      const ViewJudge judge(tree, orbit(tree, at), {.tolerance_px = tolerance_px});
      const double before = now();
      const UpdateStatistics did = front.update(judge);
      seconds.push_back(now() - before);
      changes += did.splits + did.merges;
      looked_at += did.looked_at;
      shown += front.display().triangle_count();
    }
    std::ranges::sort(seconds);
    std::printf("%u,%.0f,%.2f,%.1f,%.0f,%.4f,%.4f\n", tree.full_triangle_count(), shown / kFrames,
                step, changes / kFrames, looked_at / kFrames, 1e3 * seconds[kFrames / 2],
                1e3 * seconds.back());
    std::fflush(stdout);
  }
}

void run() {
  std::printf("# side, seconds to build\n");
  std::vector<MergeTree> trees;
  for (const std::uint32_t side : {72U, 225U, 708U, 1226U}) {
    const SurfaceMesh mesh = hills(side);
    const double before = now();
    trees.push_back(build_merge_tree(mesh));
    std::printf("# %u, %.2f, %u levels, 3 log2 n = %.1f\n", side, now() - before,
                trees.back().level_count(), 3 * std::log2(mesh.points.size()));
  }
  std::printf("full_triangles,shown,step_deg,changes,looked_at,median_ms,largest_ms\n");
  for (const MergeTree& tree : trees) measure_frames(tree, 6000);
}

/// A turn about a model, a degree a frame: medians and largest of 360 frames.
void turn_about(const MergeTree& tree, std::uint32_t triangles) {
  Eigen::Vector3i low = tree.points.front(), high = low;
  for (const Eigen::Vector3i& p : tree.points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Eigen::Vector3d middle = tree.lattice.relative(low + (high - low) / 2);
  const double reach = tree.lattice.relative(high - low).norm() / 2;
  const auto camera = [&](int degrees) {
    const double u = degrees * std::numbers::pi / 180;
    return Camera::looking_at(
        middle + reach * Eigen::Vector3d(2 * std::cos(u), 2 * std::sin(u), 0.8), middle);
  };
  ViewCriteria criteria{.tolerance_px = 1, .back_faces = true, .silhouette_px = 0.5};
  MergeFront front(tree);
  const double tolerance_px = settle_on(triangles, tree, camera(0), criteria, front);
  criteria = at_tolerance(criteria, tolerance_px);
  std::vector<double> seconds, changes;
  double shown = 0;
  for (int frame = 1; frame <= 360; ++frame) {
    front.display().forget_changes();
    const ViewJudge judge(tree, camera(frame), criteria);
    const double before = now();
    const UpdateStatistics did = front.update(judge);
    seconds.push_back(now() - before);
    changes.push_back(did.splits + did.merges);
    shown += front.display().triangle_count() / 360.0;
  }
  std::ranges::sort(seconds);
  std::ranges::sort(changes);
  std::printf(
      "%u triangles, %u levels: %.2f px, %.0f shown, %.0f changes a frame, median %.3f ms, "
      "largest %.3f ms\n",
      tree.full_triangle_count(), tree.level_count(), tolerance_px, shown, changes[180],
      1e3 * seconds[180], 1e3 * seconds.back());
}

}  // namespace
}  // namespace terrane::hierarchy

int main(int argc, char** argv) {
  if (argc < 3) {
    terrane::hierarchy::run();
    return 0;
  }
  std::ifstream file(argv[1], std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), {});
  terrane::hierarchy::turn_about(terrane::hierarchy::decode_tree(bytes, argv[1]),
                                 static_cast<std::uint32_t>(std::atoi(argv[2])));
}

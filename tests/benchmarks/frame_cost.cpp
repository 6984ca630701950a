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

/// Milliseconds of many frames.
class Times {
 public:
  void add(double seconds) { ms_.push_back(1e3 * seconds); }
  /// \param share  0.5: the median
  double at(double share) {
    std::ranges::sort(ms_);
    const auto last = static_cast<double>(ms_.size() - 1);
    return ms_[static_cast<std::size_t>(std::lround(share * last))];
  }

 private:
  std::vector<double> ms_;
};

/// Times the frames of a walk: finding what to show, and showing it.
struct FrameTimes {
  Times total, traversal;
  double changes = 0, looked_at = 0, shown = 0;  // means

  void frame(MergeFront& front, const ViewJudge& judge, int frames) {
    front.display().forget_changes();
    const double before = now();
    const UpdateStatistics did = front.decide(judge);
    const double decided = now();
    front.show();
    total.add(now() - before);
    traversal.add(decided - before);
    changes += static_cast<double>(did.splits + did.merges) / frames;
    looked_at += static_cast<double>(did.looked_at) / frames;
    shown += static_cast<double>(front.display().triangle_count()) / frames;
  }
};

/// The coarsest tolerance at which a frame looks at so many merges: the length of the front.
double tolerance_for_front(std::uint32_t merges, const MergeTree& tree, MergeFront& front) {
  double tolerance_px = 1e4;
  for (;; tolerance_px /= 1.02) {
    const ViewJudge judge(tree, orbit(tree, 0), {.tolerance_px = tolerance_px});
    front.update(judge);
    if (front.update(judge).looked_at >= merges || tolerance_px < 1e-3) return tolerance_px;
  }
}

/// Frames of steps of several sizes, a line each.
void measure_frames(const MergeTree& tree, std::uint32_t looked_at) {
  MergeFront front(tree);
  const double tolerance_px = tolerance_for_front(looked_at, tree, front);
  for (const double step : {0.0, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0}) {
    constexpr int kFrames = 200;
    FrameTimes times;
    double at = 0;
    front.update(ViewJudge(tree, orbit(tree, at), {.tolerance_px = tolerance_px}));
    for (int frame = 0; frame < kFrames; ++frame) {
      at += step;
      times.frame(front, {tree, orbit(tree, at), {.tolerance_px = tolerance_px}}, kFrames);
    }
    std::printf("%u,%.0f,%.2f,%.1f,%.0f,%.4f,%.4f,%.4f,%.4f\n", tree.full_triangle_count(),
                times.shown, step, times.changes, times.looked_at, times.total.at(0.5),
                times.total.at(0.95), times.total.at(1), times.traversal.at(0.5));
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
  std::printf(
      "full_triangles,shown,step_deg,changes,looked_at,median_ms,p95_ms,largest_ms,traversal_ms\n");
  // as many as the smallest one can have, and more
  for (const std::uint32_t looked_at : {1500U, 6000U}) {
    for (const MergeTree& tree : trees) {
      if (looked_at < tree.merge_count() / 2) measure_frames(tree, looked_at);
    }
  }
}

/// A turn about a model, a degree a frame.
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
  constexpr int kFrames = 360;
  FrameTimes times;
  for (int frame = 1; frame <= kFrames; ++frame) {
    times.frame(front, {tree, camera(frame), criteria}, kFrames);
  }
  std::printf(
      "%u triangles, %u levels: %.2f px, %.0f shown, %.0f changes a frame, %.0f looked at; ms: "
      "traversal median %.3f, update median %.3f, p95 %.3f, largest %.3f\n",
      tree.full_triangle_count(), tree.level_count(), tolerance_px, times.shown, times.changes,
      times.looked_at, times.traversal.at(0.5), times.total.at(0.5), times.total.at(0.95),
      times.total.at(1));
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

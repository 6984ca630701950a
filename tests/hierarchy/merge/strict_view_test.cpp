#include <gtest/gtest.h>

#include "hierarchy/levels/build_levels.h"
#include "hierarchy/merge/build_merge_tree.h"
#include "tests/hierarchy/merge/merge_models.h"

// Judges what is shown with code of its own: no bound, sphere or sample list of the tree is used.
namespace terrane::hierarchy {
namespace {

using namespace testing;

constexpr std::uint32_t kSide = 61;
constexpr double kOnEdge = 1e-4;  // places are rounded to 5e-7, triangles are 1e-2 wide and more

/// The height shown over each sample of a grid in [-1, 1]^2; NaN where nothing is.
std::vector<double> heights_shown(const SurfaceMesh& finest, const std::vector<Corners>& shown,
                                  const std::vector<Eigen::Vector3d>& places) {
  std::vector<double> heights(finest.points.size(), std::nan(""));
  std::vector<double> best(finest.points.size(), -1);
  const auto cell = [](double x) { return (x + 1) * (kSide - 1) / 2; };
  for (const Corners& corners : shown) {
    const Eigen::Vector3d &a = places[corners[0]], &b = places[corners[1]], &c = places[corners[2]];
    const auto low = [&](int k) { return std::min({a[k], b[k], c[k]}); };
    const auto high = [&](int k) { return std::max({a[k], b[k], c[k]}); };
    for (auto j = std::max(0, int(std::floor(cell(low(1))))); j <= std::ceil(cell(high(1))); ++j) {
      for (auto i = std::max(0, int(std::floor(cell(low(0))))); i <= std::ceil(cell(high(0)));
           ++i) {
        if (i >= int(kSide) || j >= int(kSide)) continue;
        const std::size_t s = std::size_t(j) * kSide + std::size_t(i);
        const Eigen::Vector2d p = finest.points[s].head<2>();
        Eigen::Matrix2d sides;
        sides << (b - a).head<2>(), (c - a).head<2>();
        const Eigen::Vector2d uv = sides.inverse() * (p - a.head<2>());
        // samples on edges are rounded: the triangle counts that is nearest to covering one
        const double inside = std::min(uv.minCoeff(), 1 - uv.sum());
        if (inside < -kOnEdge || inside <= best[s]) continue;
        best[s] = inside;
        heights[s] = a.z() + uv[0] * (b.z() - a.z()) + uv[1] * (c.z() - a.z());
      }
    }
  }
  return heights;
}

struct Picture {
  Eigen::Vector2d at;
  bool is_inside = false;
};

Picture picture_of(const Camera& camera, const Eigen::Vector3d& p) {
  const Eigen::Vector3d up = camera.right.cross(camera.forward);
  const Eigen::Vector3d q = p - camera.eye;
  const double z = q.dot(camera.forward);
  const double focal = camera.height_px / 2 / std::tan(camera.vertical_fov_deg * M_PI / 360);
  const Eigen::Vector2d at = focal * Eigen::Vector2d(q.dot(camera.right), q.dot(up)) / z;
  return {at, z > 0 && std::abs(at.x()) <= camera.width_px / 2 &&
                  std::abs(at.y()) <= camera.height_px / 2};
}

/// Largest distance in the picture between a sample and what is shown over it, and at how many
/// samples there was something to compare.
std::pair<double, int> worst_in_picture(const SurfaceMesh& finest, const MergeTree& tree,
                                        const MergeFront& front, const Camera& camera) {
  std::vector<Eigen::Vector3d> places;
  for (std::uint32_t v = 0; v < tree.points.size(); ++v) {
    places.push_back(tree.lattice.origin() + tree.place(v).cast<double>());
  }
  const auto heights = heights_shown(finest, shown_triangles(tree, front), places);
  double worst = 0;
  int count = 0;
  for (std::size_t s = 0; s < heights.size(); ++s) {
    EXPECT_FALSE(std::isnan(heights[s])) << "sample " << s << " is uncovered";
    const Eigen::Vector3d there = finest.points[s] - tree.lattice.origin();
    const Picture is = picture_of(camera, there);
    if (!is.is_inside) continue;
    const Eigen::Vector3d shown(there.x(), there.y(), heights[s] - tree.lattice.origin().z());
    worst = std::max(worst, (picture_of(camera, shown).at - is.at).norm());
    ++count;
  }
  return {worst, count};
}

void expect_strict(const SurfaceMesh& finest, const MergeTree& tree, bool frustum) {
  ASSERT_EQ(tree.measure, ErrorMeasure::kVertical);
  MergeFront front(tree);
  RandomViews views(tree, 21);
  int compared = 0;
  double largest_share = 0;
  for (int view = 0; view < 100; ++view) {
    const Camera camera = views.camera();
    const double tolerance_px = views.between(0.3, 5);
    front.update(ViewJudge(tree, camera, {.tolerance_px = tolerance_px, .frustum = frustum}));
    const auto [worst, count] = worst_in_picture(finest, tree, front, camera);
    // 0.002: the lattice that samples were rounded to, as seen from the nearest camera
    ASSERT_LE(worst, tolerance_px + 0.002) << "view " << view;
    largest_share = std::max(largest_share, worst / tolerance_px);
    compared += count;
  }
  EXPECT_GT(compared, 10000);
  EXPECT_GT(largest_share, 0.3) << "the bound is far from what is shown: triangles are wasted";
}

TEST(StrictView, EverySampleOfATerrainIsShownWithinTheToleranceForRandomCameras) {
  const SurfaceMesh finest = hills(kSide, kSide);
  expect_strict(finest, build_merge_tree(finest), false);
  expect_strict(finest, build_merge_tree(finest), true);
  expect_strict(finest, build_merge_tree(finest, {.order = CollapseOrder::kLength}), false);
}

TEST(StrictView, TrianglesThatCollapsedKeepTheToleranceToo) {
  const SurfaceMesh finest = hills(kSide, kSide);
  expect_strict(finest, merge_tree_of(build_levels(finest)), false);
}

TEST(StrictView, EveryVertexOfAnObjectIsWithinTheErrorOfWhatIsShown) {
  const MergeTree tree = build_merge_tree(torn_torus(60, 24));
  MergeFront front(tree);
  RandomViews views(tree, 8);
  for (int view = 0; view < 6; ++view) {
    front.update(ViewJudge(tree, views.camera(), {.tolerance_px = 3}));
    double bound = 0;
    for (std::uint32_t i = 0; i < tree.merge_count(); ++i) {
      if (front.is_made(i)) bound = std::max(bound, double(tree.bounds[i].error));
    }
    const auto shown = shown_triangles(tree, front);
    for (std::uint32_t v = 0; v < tree.points.size(); ++v) {
      // by brute force: dense points of each triangle stand for it
      double nearest = 1e9;
      const Eigen::Vector3d p = tree.place(v).cast<double>();
      for (const Corners& c : shown) {
        const Eigen::Vector3d a = tree.place(c[0]).cast<double>(),
                              b = tree.place(c[1]).cast<double>(),
                              d = tree.place(c[2]).cast<double>();
        const double reach = std::max((b - a).norm(), (d - a).norm());
        if ((p - a).norm() > reach + bound + 1e-9) continue;
        for (int i = 0; i <= 24; ++i) {
          for (int j = 0; i + j <= 24; ++j) {
            nearest = std::min(nearest, (a + (b - a) * i / 24 + (d - a) * j / 24 - p).norm());
          }
        }
      }
      ASSERT_LE(nearest, bound + 0.03) << "vertex " << v;
    }
  }
}

}  // namespace
}  // namespace terrane::hierarchy

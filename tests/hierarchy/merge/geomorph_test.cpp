#include "hierarchy/merge/geomorph.h"

#include <gtest/gtest.h>

#include "hierarchy/merge/build_merge_tree.h"
#include "tests/hierarchy/merge/merge_models.h"

namespace terrane::hierarchy {
namespace {

using namespace testing;

Eigen::Vector3f position(const DisplayMesh& display, std::uint32_t slot) {
  return Eigen::Map<const Eigen::Vector3f>(&display.positions()[3 * std::size_t{slot}]);
}

/// Smallest plan area of the triangles as they are drawn.
double smallest_plan_area(const DisplayMesh& display) {
  double smallest = 1;
  for (std::size_t i = 0; i < display.indices().size(); i += 3) {
    const Eigen::Vector3d a = position(display, display.indices()[i]).cast<double>(),
                          u = position(display, display.indices()[i + 1]).cast<double>() - a,
                          v = position(display, display.indices()[i + 2]).cast<double>() - a;
    smallest = std::min(smallest, u.x() * v.y() - u.y() * v.x());
  }
  return smallest;
}

/// Farthest that a vertex which shows in two frames went between them.
double farthest_step(const MergeTree& tree, const DisplayMesh& display,
                     std::map<std::uint32_t, Eigen::Vector3f>& before) {
  double farthest = 0;
  std::map<std::uint32_t, Eigen::Vector3f> now;
  for (std::size_t i = 0; i < display.indices().size(); ++i) {
    const std::uint32_t v = tree.triangles[display.shown()[i / 3]][i % 3];
    now[v] = position(display, display.indices()[i]);
    if (const auto old = before.find(v); old != before.end()) {
      farthest = std::max(farthest, double((now[v] - old->second).norm()));
    }
  }
  before = now;
  return farthest;
}

TEST(Geomorph, NothingTurnsOverInPlanOnTheWay) {
  const MergeTree tree = build_merge_tree(hills(41, 41));
  MergeFront front(tree, 5);
  RandomViews views(tree, 17);
  Camera camera = views.camera();
  for (int frame = 0; frame < 400; ++frame) {
    if (frame % 40 == 0) camera = views.camera();
    camera.eye += 0.05 * views.direction();
    front.update(ViewJudge(tree, camera, {.tolerance_px = 2}));
    // a child that is at its parent's place makes triangles without area; floats round the rest
    ASSERT_GE(smallest_plan_area(front.display()), -1e-6) << "frame " << frame;
  }
}

TEST(Geomorph, ComesToWhatIsShownWithoutIt) {
  const MergeTree tree = build_merge_tree(torn_torus(40, 16));
  MergeFront morphing(tree, 4), plain(tree);
  RandomViews views(tree, 6);
  for (int view = 0; view < 10; ++view) {
    const ViewJudge judge(tree, views.camera(), views.criteria());
    plain.update(judge);
    int frames = 0;
    do {
      morphing.update(judge);
      ASSERT_LT(++frames, 2000);
    } while (!morphing.is_settled());
    EXPECT_TRUE(shape_shown(tree, morphing) == shape_shown(tree, plain));
    for (std::size_t i = 0; i < morphing.display().indices().size(); ++i) {
      const std::uint32_t v = tree.triangles[morphing.display().shown()[i / 3]][i % 3];
      ASSERT_EQ(position(morphing.display(), morphing.display().indices()[i]), tree.place(v));
    }
  }
}

TEST(Geomorph, AVertexGoesAFewStepsInsteadOfALeap) {
  // no merge on top of another: each child goes the length of its edge in ten steps
  const MergeTree tree = build_merge_tree(sphere(2), {.fewest_vertices = 60});
  ASSERT_EQ(tree.level_count(), 1U);
  MergeFront front(tree, 10);
  const Camera camera = RandomViews(tree, 2).camera();
  std::map<std::uint32_t, Eigen::Vector3f> before;
  farthest_step(tree, front.display(), before);
  for (const double tolerance_px : {0.0, 1e6}) {
    for (int frame = 0; frame < 12; ++frame) {
      front.update(ViewJudge(tree, camera, {.tolerance_px = tolerance_px}));
      EXPECT_LE(farthest_step(tree, front.display(), before), 0.08) << "an edge is 0.8 at most";
    }
  }
  EXPECT_EQ(front.display().triangle_count(), tree.coarsest_triangles);
}

}  // namespace
}  // namespace terrane::hierarchy

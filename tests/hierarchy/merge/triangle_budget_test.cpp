#include "hierarchy/merge/triangle_budget.h"

#include <gtest/gtest.h>

#include "hierarchy/merge/build_merge_tree.h"
#include "tests/hierarchy/merge/merge_models.h"

namespace terrane::hierarchy {
namespace {

using namespace testing;

TEST(TriangleBudget, FeedbackComesNearTheBudgetWithinAFewFrames) {
  const MergeTree tree = build_merge_tree(hills(81, 81));
  MergeFront front(tree);
  TriangleBudget budget(2000);
  RandomViews views(tree, 3);
  for (int view = 0; view < 5; ++view) {
    const Camera camera = views.camera();
    for (int frame = 0; frame < 12; ++frame) {
      front.update(ViewJudge(tree, camera, {.tolerance_px = budget.tolerance_px()}));
      budget.correct(front.display().triangle_count());
    }
    EXPECT_NEAR(front.display().triangle_count(), 2000, 100);
  }
}

TEST(SettleOn, ShowsAsManyTrianglesAsTheBudgetAllowsAndNoMore) {
  const MergeTree tree = build_merge_tree(sphere(5));
  MergeFront front(tree);
  const Eigen::Vector3d middle = -tree.lattice.origin();
  const Camera camera = Camera::looking_at(middle + Eigen::Vector3d(0, -4, 1), middle);
  for (const std::uint32_t budget : {100U, 537U, 3000U}) {
    settle_on(budget, tree, camera, {}, front);
    EXPECT_LE(front.display().triangle_count(), budget);
    EXPECT_GT(front.display().triangle_count(), budget * 8 / 10);
  }
  settle_on(1'000'000, tree, camera, {}, front);
  EXPECT_EQ(front.display().triangle_count(), tree.full_triangle_count());
  settle_on(1, tree, camera, {}, front);
  EXPECT_EQ(front.display().triangle_count(), tree.coarsest_triangles);
}

}  // namespace
}  // namespace terrane::hierarchy

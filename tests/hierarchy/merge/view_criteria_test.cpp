#include "hierarchy/merge/view_criteria.h"

#include <gtest/gtest.h>

#include "core/errors.h"
#include "hierarchy/merge/build_merge_tree.h"
#include "tests/hierarchy/merge/merge_models.h"

namespace terrane::hierarchy {
namespace {

using namespace testing;

class SphereView : public ::testing::Test {
 protected:
  std::uint32_t triangles(const ViewCriteria& criteria) {
    front_.update(ViewJudge(tree_, camera_, criteria));
    return front_.display().triangle_count();
  }
  /// Triangles that show with a corner on one side of a plane through the middle.
  std::uint32_t triangles_towards(const Eigen::Vector3d& direction, double from) {
    std::uint32_t count = 0;
    for (const Corners& c : shown_triangles(tree_, front_)) {
      const Eigen::Vector3d p = tree_.place(c[0]).cast<double>() + tree_.lattice.origin();
      count += p.dot(direction) > from;
    }
    return count;
  }

  const MergeTree tree_ = build_merge_tree(sphere(5));
  MergeFront front_{tree_};
  const Eigen::Vector3d middle_ = -tree_.lattice.origin();
  const Camera camera_ = Camera::looking_at(middle_ + Eigen::Vector3d(0, -4, 0), middle_);
};

TEST_F(SphereView, AHigherToleranceShowsFewerTriangles) {
  EXPECT_LT(triangles({.tolerance_px = 4}), triangles({.tolerance_px = 1}));
}

TEST_F(SphereView, BackFacesGoAndFrontFacesStay) {
  const std::uint32_t all = triangles({.tolerance_px = 1});
  const std::uint32_t front = triangles_towards({0, -1, 0}, 0.3);
  EXPECT_LT(triangles({.tolerance_px = 1, .back_faces = true}), all * 3 / 4);
  EXPECT_GE(triangles_towards({0, -1, 0}, 0.3), front);
}

TEST_F(SphereView, SilhouettesAreFinerThanWhatFacesTheEye) {
  triangles({.tolerance_px = 8});
  const std::uint32_t facing = triangles_towards({0, -1, 0}, 0.7);
  triangles({.tolerance_px = 8, .silhouette_px = 0.5});
  EXPECT_LT(triangles_towards({0, -1, 0}, 0.9), facing * 2);
  EXPECT_GT(front_.display().triangle_count(), 2 * facing);
}

TEST_F(SphereView, HighlightsAreFineWhereTheyAre) {
  // eye and light in one direction: so is the highlight
  triangles({.tolerance_px = 20, .highlight_px = 20, .to_light = {0, -1, 0}});
  const std::uint32_t lit = triangles_towards({0, -1, 0}, 0.7);
  const std::uint32_t dark = triangles_towards({0, 1, 0}, 0.7);
  EXPECT_GT(lit, 4 * dark);
}

TEST(ViewCriteria, ColoursAreFineWhereTheyVary) {
  SurfaceMesh mesh = sphere(5);
  for (const Eigen::Vector3d& p : mesh.points) {
    mesh.colours.push_back(p.x() > 0 ? Colour{200, 200, 200} : Colour{90, 90, 90});
  }
  const MergeTree tree = build_merge_tree(mesh);
  const Eigen::Vector3d middle = -tree.lattice.origin();
  const Camera camera = Camera::looking_at(middle + Eigen::Vector3d(0, -4, 0), middle);
  MergeFront front(tree);
  const auto shown_at = [&](double low, double high) {
    std::uint32_t count = 0;
    for (const Corners& c : shown_triangles(tree, front)) {
      const double x = std::abs(tree.place(c[0]).x() - middle.x());
      count += x >= low && x < high;
    }
    return count;
  };
  front.update(ViewJudge(tree, camera, {.tolerance_px = 20}));
  const std::uint32_t coarse = front.display().triangle_count(), coarse_away = shown_at(0.4, 2);
  front.update(ViewJudge(tree, camera, {.tolerance_px = 20, .colour_px = 10}));
  EXPECT_GT(shown_at(0, 0.2), 4 * coarse);
  EXPECT_LT(shown_at(0.4, 2), 4 * coarse_away);
  // a border that is no sharper than what is tolerated is none
  front.update(
      ViewJudge(tree, camera, {.tolerance_px = 20, .colour_px = 10, .colour_contrast = 0.5}));
  EXPECT_EQ(front.display().triangle_count(), coarse);
}

TEST_F(SphereView, NothingIsWantedBehindTheCamera) {
  const Camera away = Camera::looking_at(camera_.eye, camera_.eye + Eigen::Vector3d(0, -1, 0));
  front_.update(ViewJudge(tree_, away, {.tolerance_px = 1, .frustum = true}));
  EXPECT_EQ(front_.display().triangle_count(), tree_.coarsest_triangles);
}

TEST(ViewJudge, WhatIsAllowedAsAWholeIsAllowedInEveryPart) {
  const MergeTree tree = build_merge_tree(torn_torus(40, 16));
  RandomViews views(tree, 13);
  for (int view = 0; view < 200; ++view) {
    const ViewJudge judge(tree, views.camera(), views.criteria());
    // all_allowed[i]: allows() of i and of everything before it
    std::vector<bool> all_allowed(tree.merge_count());
    for (std::uint32_t i = tree.merge_count(); i-- > 0;) {
      all_allowed[i] = judge.allows(i);
      for (const std::uint32_t f : tree.finer(i)) all_allowed[i] = all_allowed[i] && all_allowed[f];
      if (judge.allows_all(i)) {
        ASSERT_TRUE(all_allowed[i]) << "view " << view << ", merge " << i;
      }
    }
  }
}

TEST(Camera, RefusesAViewAlongItsOwnUp) {
  EXPECT_THROW(Camera::looking_at({0, 0, 5}, {0, 0, 0}), ConfigError);
  EXPECT_THROW(Camera::looking_at({0, 0, 5}, {0, 0, 5}), ConfigError);
}

}  // namespace
}  // namespace terrane::hierarchy

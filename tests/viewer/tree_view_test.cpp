#include "viewer/engine/tree_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/errors.h"
#include "hierarchy/merge/build_merge_tree.h"
#include "hierarchy/merge/tree_file.h"

namespace terrane::viewer {
namespace {

using hierarchy::ChangedRange;
using hierarchy::SurfaceMesh;

constexpr std::uint32_t kSide = 40;

/// Hills of 3,042 triangles over [100, 102] x [200, 202].
std::string hills() {
  SurfaceMesh mesh;
  for (std::uint32_t j = 0; j < kSide; ++j) {
    for (std::uint32_t i = 0; i < kSide; ++i) {
      const double x = 2.0 * i / (kSide - 1), y = 2.0 * j / (kSide - 1);
      mesh.points.push_back({100 + x, 200 + y, 0.2 * std::sin(3 * x) * std::cos(4 * y)});
    }
  }
  for (std::uint32_t j = 0; j + 1 < kSide; ++j) {
    for (std::uint32_t i = 0; i + 1 < kSide; ++i) {
      const std::uint32_t a = j * kSide + i, b = a + 1, c = a + kSide + 1, d = a + kSide;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return hierarchy::encode_tree(hierarchy::build_merge_tree(mesh));
}

TreeCamera from(double x, double y) {
  return {.eye = {x, y, 2}, .target = {101, 201, 0}, .up = {0, 0, 1}};
}

/// What a graphics card holds that is sent nothing but the changed ranges.
struct Card {
  std::vector<std::uint32_t> indices;
  std::vector<float> positions, normals;

  void take(const TreeView& view) {
    copy(view.changed_triangles(), view.display().indices(), indices);
    copy(view.changed_vertices(), view.display().positions(), positions);
    copy(view.changed_vertices(), view.display().normals(), normals);
  }

 private:
  template <typename T>
  static void copy(const std::vector<ChangedRange>& ranges, const std::vector<T>& from,
                   std::vector<T>& to) {
    to.resize(from.size());
    for (const auto [begin, end] : ranges) {
      std::copy(from.begin() + 3 * begin, from.begin() + 3 * end, to.begin() + 3 * begin);
    }
  }
};

TEST(TreeView, WhatItSaysHasChangedIsAllThatHasToBeSent) {
  TreeView view(hills(), "hills");
  Card card;
  std::size_t sent = 0;
  for (int frame = 0; frame < 40; ++frame) {
    view.look(from(101 + 2 * std::cos(0.1 * frame), 201 + 2 * std::sin(0.1 * frame)));
    view.update();
    card.take(view);
    ASSERT_EQ(card.indices, view.display().indices()) << frame;
    ASSERT_EQ(card.positions, view.display().positions()) << frame;
    ASSERT_EQ(card.normals, view.display().normals()) << frame;
    if (frame == 0) continue;
    for (const auto [begin, end] : view.changed_triangles()) sent += end - begin;
  }
  EXPECT_GT(sent, 0u);
  EXPECT_LT(sent, 39 * view.display().triangle_count() / 2);
}

TEST(TreeView, ShowsWhatAFrontOfTheLibraryShows) {
  TreeView view(hills(), "hills");
  view.look(from(99, 199));
  view.set_criteria({.tolerance_px = 3});
  view.update();
  EXPECT_TRUE(view.is_settled());

  const auto& tree = view.tree();
  const Eigen::Vector3d& origin = tree.lattice.origin();
  hierarchy::MergeFront front(tree);
  front.update({tree,
                hierarchy::Camera::looking_at(Eigen::Vector3d(99, 199, 2) - origin,
                                              Eigen::Vector3d(101, 201, 0) - origin),
                {.tolerance_px = 3}});
  EXPECT_THAT(view.display().shown(),
              ::testing::UnorderedElementsAreArray(front.display().shown()));
}

TEST(TreeView, FindsABudgetWithinSomeFrames) {
  TreeView view(hills(), "hills");
  view.look(from(99, 199));
  view.set_budget(700);
  int frames = 0;
  for (; frames == 0 || (!view.is_settled() && frames < 60); ++frames) view.update();
  EXPECT_LT(frames, 60);
  EXPECT_NEAR(view.display().triangle_count(), 700, 35);
}

TEST(TreeView, BlendsToTheSameMesh) {
  TreeView view(hills(), "hills");
  view.look(from(99, 199));
  view.update();
  const std::uint32_t triangles = view.display().triangle_count();
  view.set_morph_frames(5);
  int frames = 0;
  for (; frames == 0 || (!view.is_settled() && frames < 100); ++frames) view.update();
  EXPECT_GE(frames, 5);
  EXPECT_LT(frames, 100);
  EXPECT_EQ(view.display().triangle_count(), triangles);
}

TEST(TreeView, RefusesWhatIsNoTreeAndACameraThatLooksNowhere) {
  EXPECT_THROW(TreeView("glTF", "mesh.glb"), InputError);
  TreeView view(hills(), "hills");
  EXPECT_THROW(view.look({.eye = {1, 2, 3}, .target = {1, 2, 3}, .up = {0, 0, 1}}), ConfigError);
}

}  // namespace
}  // namespace terrane::viewer

#include "hierarchy/merge/merge_front.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <unordered_set>

#include "hierarchy/levels/build_levels.h"
#include "hierarchy/merge/build_merge_tree.h"
#include "tests/hierarchy/merge/merge_models.h"

namespace terrane::hierarchy {
namespace {

using namespace testing;

/// Frames of a walk: few where every change is tested, 10,000 where someone asks for them.
int frames_of_a_walk() {
  const char* const wanted = std::getenv("TERRANE_WALK_FRAMES");
  return wanted != nullptr ? std::atoi(wanted) : 200;
}

std::uint64_t directed(std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; }

/// Edges that one triangle alone has; -1 if two triangles run along an edge in one direction.
long border_edges(const std::vector<Corners>& triangles) {
  std::unordered_set<std::uint64_t> edges;
  edges.reserve(triangles.size() * 3);
  for (const Corners& c : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!edges.insert(directed(c[k], c[(k + 1) % 3])).second) return -1;
    }
  }
  long count = 0;
  for (const std::uint64_t e : edges) {
    count += !edges.contains(
        directed(static_cast<std::uint32_t>(e), static_cast<std::uint32_t>(e >> 32)));
  }
  return count;
}

/// Twice the plan area, exact; -1 if a triangle is turned over.
std::int64_t plan_area(const MergeTree& tree, const std::vector<Corners>& triangles) {
  std::int64_t sum = 0;
  for (const Corners& c : triangles) {
    const Eigen::Vector3i a = tree.points[c[0]], u = tree.points[c[1]] - a,
                          v = tree.points[c[2]] - a;
    const std::int64_t area = std::int64_t{u.x()} * v.y() - std::int64_t{u.y()} * v.x();
    if (area <= 0) return -1;
    sum += area;
  }
  return sum;
}

/// A triangle that is not of the full mesh and faces away from its normal at a corner.
bool has_fold(const MergeTree& tree, const MergeFront& front,
              const std::vector<Eigen::Vector3d>& normals, const std::vector<bool>& is_full) {
  for (const std::uint32_t t : front.display().shown()) {
    if (is_full[t]) continue;
    const Corners& c = tree.triangles[t];
    const Eigen::Vector3d a = tree.place(c[0]).cast<double>();
    const Eigen::Vector3d area =
        (tree.place(c[1]).cast<double>() - a).cross(tree.place(c[2]).cast<double>() - a);
    for (const std::uint32_t v : c) {
      if (area.dot(normals[v]) <= 0) return true;
    }
  }
  return false;
}

bool keeps_dependencies(const MergeTree& tree, const MergeFront& front) {
  for (std::uint32_t i = 0; i < tree.merge_count(); ++i) {
    if (!front.is_made(i)) continue;
    for (const std::uint32_t f : tree.finer(i)) {
      if (!front.is_made(f)) return false;
    }
  }
  return true;
}

/// Sum of the area vectors about each vertex of the full mesh: written again, for the judge.
std::vector<Eigen::Vector3d> normals_of(const MergeTree& tree) {
  std::vector<Eigen::Vector3d> sums(tree.points.size(), Eigen::Vector3d::Zero());
  for (const Corners& c : full_mesh_triangles(tree)) {
    const Eigen::Vector3d a = tree.place(c[0]).cast<double>();
    const Eigen::Vector3d area =
        (tree.place(c[1]).cast<double>() - a).cross(tree.place(c[2]).cast<double>() - a);
    for (const std::uint32_t v : c) sums[v] += area;
  }
  return sums;
}

/// Walks at random, by steps and by leaps, and looks at every frame.
void walk(const MergeTree& tree, bool may_fold = false) {
  MergeFront front(tree);
  RandomViews views(tree, 7);
  const std::vector<Corners> full = full_mesh_triangles(tree);
  const Oracle expected(full);
  ASSERT_TRUE(expected.is_manifold);
  const bool is_terrain = tree.measure == ErrorMeasure::kVertical;
  const std::int64_t area = is_terrain ? plan_area(tree, full) : 0;
  const std::vector<Eigen::Vector3d> normals = normals_of(tree);
  const std::vector<bool> is_full = full_triangles(tree);

  Camera camera = views.camera();
  ViewCriteria criteria = views.criteria();
  const int frames = frames_of_a_walk();
  for (int frame = 0; frame < frames; ++frame) {
    camera.eye += 0.02 * views.direction();
    criteria.to_light = (criteria.to_light + 0.05 * views.direction()).normalized();
    if (frame % 25 == 0) camera = views.camera();
    if (frame % 50 == 0) criteria = views.criteria();
    front.update(ViewJudge(tree, camera, criteria));

    const std::vector<Corners> shown = shown_triangles(tree, front);
    ASSERT_GE(border_edges(shown), 0) << "frame " << frame;
    ASSERT_EQ(border_edges(shown) == 0, expected.border_edges == 0) << "frame " << frame;
    if (is_terrain && !may_fold) {
      ASSERT_EQ(plan_area(tree, shown), area) << "frame " << frame;
    }
    if (!may_fold && !is_terrain) {
      ASSERT_FALSE(has_fold(tree, front, normals, is_full)) << "frame " << frame;
    }
    ASSERT_TRUE(keeps_dependencies(tree, front)) << "frame " << frame;
    if (frame % 20 == 0) {
      const Oracle oracle(shown);
      ASSERT_TRUE(oracle.is_manifold) << "frame " << frame;
      ASSERT_EQ(oracle.euler, expected.euler) << "frame " << frame;
    }
  }
}

TEST(MergeFront, StaysAManifoldWithoutFoldsOnAWalkAboutASphere) {
  walk(build_merge_tree(sphere(4)));
  walk(build_merge_tree(
      sphere(4), {.order = CollapseOrder::kLength, .region = Region::kBothEnds, .share = 1}));
}

TEST(MergeFront, StaysAManifoldWithoutFoldsOnAWalkAboutATornTorus) {
  walk(build_merge_tree(torn_torus(60, 24)));
  walk(build_merge_tree(torn_torus(60, 24), {.order = CollapseOrder::kLength}));
}

TEST(MergeFront, StaysAManifoldOnAWalkAboutAnObjectWithEdgesAndHoles) {
  std::mt19937 random(5);
  SurfaceMesh slab = Slab(2, 4).mesh();
  jitter(slab, 0.15, random);
  for (Eigen::Vector3d& p : slab.points) p = p / 10 - Eigen::Vector3d(1, 0.6, 0.2);
  walk(build_merge_tree(slab, {.order = CollapseOrder::kLength}));
}

TEST(MergeFront, CoversTheSamePlanWithoutFoldsOnAWalkOverHills) {
  walk(build_merge_tree(hills(41, 41)));
  walk(build_merge_tree(hills(41, 31),
                        {.order = CollapseOrder::kLength, .region = Region::kBothEnds}));
}

TEST(MergeFront, StaysAManifoldOnWalksOverTriangleCollapses) {
  walk(merge_tree_of(build_levels(hills(41, 41))));
  walk(merge_tree_of(build_levels(torus(50, 20))), /*may_fold=*/true);
}

TEST(MergeFront, ShowsTheSameMeshWheneverACameraComesBack) {
  const MergeTree tree = build_merge_tree(torn_torus(60, 24));
  RandomViews views(tree, 3);
  std::vector<std::pair<Camera, ViewCriteria>> seen;
  for (int i = 0; i < 20; ++i) seen.emplace_back(views.camera(), views.criteria());

  MergeFront front(tree);
  std::vector<std::multiset<std::array<Place, 3>>> first;
  for (const auto& [camera, criteria] : seen) {
    front.update(ViewJudge(tree, camera, criteria));
    first.push_back(shape_shown(tree, front));
  }
  for (std::size_t i = seen.size(); i-- > 0;) {
    front.update(ViewJudge(tree, seen[i].first, seen[i].second));
    EXPECT_TRUE(shape_shown(tree, front) == first[i]) << i;
    MergeFront fresh(tree);
    fresh.update(ViewJudge(tree, seen[i].first, seen[i].second));
    EXPECT_TRUE(shape_shown(tree, fresh) == first[i]) << i;
  }
}

TEST(MergeFront, ShowsTheLargestSetOfMergesThatTheJudgeAllows) {
  const MergeTree tree = build_merge_tree(hills(33, 33));
  RandomViews views(tree, 11);
  MergeFront front(tree);
  for (int frame = 0; frame < 50; ++frame) {
    const ViewJudge judge(tree, views.camera(), views.criteria());
    front.update(judge);
    // by definition, from the finest merges up: allowed, and all before it are made
    std::vector<bool> made(tree.merge_count());
    for (std::uint32_t i = tree.merge_count(); i-- > 0;) {
      made[i] = judge.allows(i);
      for (const std::uint32_t f : tree.finer(i)) made[i] = made[i] && made[f];
      ASSERT_EQ(made[i], front.is_made(i)) << "frame " << frame << ", merge " << i;
    }
  }
}

TEST(MergeFront, GivesTheFullMeshWhereNoErrorIsTolerated) {
  const SurfaceMesh mesh = torn_torus(40, 16);
  const MergeTree tree = build_merge_tree(mesh);
  MergeFront front(tree);
  const Camera camera = RandomViews(tree, 1).camera();
  front.update(ViewJudge(tree, camera, {.tolerance_px = 0}));
  EXPECT_EQ(front.display().triangle_count(), mesh.triangles.size());
}

TEST(MergeFront, ChangesNothingWhereTheViewStays) {
  const MergeTree tree = build_merge_tree(sphere(4));
  MergeFront front(tree);
  const Camera camera = RandomViews(tree, 1).camera();
  EXPECT_GT(front.update(ViewJudge(tree, camera, {.tolerance_px = 1})).splits, 0U);
  front.display().forget_changes();
  const UpdateStatistics again = front.update(ViewJudge(tree, camera, {.tolerance_px = 1}));
  EXPECT_EQ(again.splits + again.merges, 0U);
  EXPECT_TRUE(front.display().changed_triangles().empty());
  EXPECT_TRUE(front.display().changed_vertices().empty());
}

}  // namespace
}  // namespace terrane::hierarchy

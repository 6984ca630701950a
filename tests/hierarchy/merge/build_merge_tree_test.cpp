#include "hierarchy/merge/build_merge_tree.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.h"
#include "hierarchy/levels/build_levels.h"
#include "tests/hierarchy/merge/merge_models.h"

namespace terrane::hierarchy {
namespace {

using namespace testing;

SurfaceMesh mesh_of(const MergeTree& tree, const std::vector<Corners>& triangles) {
  SurfaceMesh mesh;
  for (const Eigen::Vector3i& p : tree.points) {
    mesh.points.push_back(tree.lattice.origin() + tree.lattice.relative(p));
  }
  mesh.triangles = triangles;
  return mesh;
}

/// What is rounded to the lattice already, so that a tree keeps it to the bit.
SurfaceMesh on_lattice(SurfaceMesh mesh) {
  const PointLattice lattice = PointLattice::around(mesh.points);
  for (Eigen::Vector3d& p : mesh.points) {
    p = lattice.origin() + lattice.round(p - lattice.origin());
  }
  return mesh;
}

TEST(BuildMergeTree, ItsFinestTrianglesAreTheMesh) {
  for (const SurfaceMesh& mesh :
       {on_lattice(sphere(3)), on_lattice(torn_torus(40, 16)), on_lattice(hills(21, 17))}) {
    for (const CollapseOrder order : {CollapseOrder::kLength, CollapseOrder::kError}) {
      const MergeTree tree = build_merge_tree(mesh, {.order = order});
      EXPECT_TRUE(shape_of_mesh(mesh_of(tree, full_mesh_triangles(tree))) == shape_of_mesh(mesh));
    }
  }
}

TEST(BuildMergeTree, ComesDownToEightVerticesOfASphereInLogarithmicallyManyLevels) {
  for (const CollapseOrder order : {CollapseOrder::kLength, CollapseOrder::kError}) {
    const MergeTree tree = build_merge_tree(sphere(5), {.order = order});
    EXPECT_LE(tree.coarsest_points, 8U);
    EXPECT_LE(tree.level_count(), 3 * std::log2(4098));
  }
}

TEST(BuildMergeTree, TheRegionsOfALevelShareNoTriangle) {
  const MergeTree tree = build_merge_tree(hills(41, 41), {.order = CollapseOrder::kLength});
  for (std::uint32_t i = 0; i < tree.merge_count(); ++i) {
    for (const std::uint32_t c : tree.coarser(i)) {
      ASSERT_GT(tree.merges[c].level, tree.merges[i].level);
    }
  }
}

/// Region::kBothEnds: exactly the published rule, from the triangles that show.
TEST(BuildMergeTree, AMergeOfBothEndsIsFreeExactlyWhereItsNeighboursAreThePublishedOnes) {
  const MergeTree tree = build_merge_tree(sphere(3), {.region = Region::kBothEnds});
  // all triangles at parent and child, in the mesh that the collapse was built in
  std::vector<std::set<Corners>> regions(tree.merge_count());
  std::set<std::uint32_t> shown;
  for (std::uint32_t t = 0; t < tree.coarsest_triangles; ++t) shown.insert(t);
  for (std::uint32_t i = 0; i < tree.merge_count(); ++i) {
    for (const std::uint32_t t : tree.coarse(i)) shown.erase(t);
    for (std::uint32_t t = tree.merges[i].fine_begin; t < tree.merges[i].fine_end; ++t) {
      shown.insert(t);
    }
    for (const std::uint32_t t : shown) {
      const Corners& c = tree.triangles[t];
      for (const std::uint32_t v : c) {
        if (v == tree.merges[i].parent || v == tree.merges[i].first_child) regions[i].insert(c);
      }
    }
  }
  RandomViews views(tree, 5);
  MergeFront front(tree);
  for (int frame = 0; frame < 60; ++frame) {
    front.update(ViewJudge(tree, views.camera(), views.criteria()));
    std::set<Corners> now;
    for (const Corners& c : shown_triangles(tree, front)) now.insert(c);
    for (std::uint32_t i = 0; i < tree.merge_count(); ++i) {
      if (front.is_made(i)) continue;
      bool is_free = true;
      for (const std::uint32_t f : tree.finer(i)) is_free = is_free && front.is_made(f);
      // rule 1: the neighbours are there; rule 2: c is not itself one of a collapse still to come
      bool is_published = std::ranges::includes(now, regions[i]);
      for (std::uint32_t k = i + 1; k < tree.merge_count() && is_published; ++k) {
        if (front.is_made(k)) continue;
        for (const Corners& c : regions[k]) {
          if (std::ranges::count(c, tree.merges[i].first_child) != 0) is_published = false;
        }
      }
      ASSERT_EQ(is_free, is_published) << frame << ", merge " << i;
    }
  }
}

TEST(BuildMergeTree, SwitchDistancesGrowTowardsTheRootAndAreThatOfTheEdgeAtLeast) {
  const MergeTree tree = build_merge_tree(torn_torus(40, 16), {.order = CollapseOrder::kLength});
  std::vector<float> down(tree.points.size(), 0);
  for (std::uint32_t i = tree.merge_count(); i-- > 0;) {
    const Merge& merge = tree.merges[i];
    const float length = (tree.place(merge.parent) - tree.place(merge.first_child)).norm();
    EXPECT_GE(tree.bounds[i].switched, length * 0.999999f);
    EXPECT_GE(tree.bounds[i].switched, down[merge.first_child]);
    down[merge.parent] = std::max(down[merge.parent], tree.bounds[i].switched);
  }
}

TEST(BuildMergeTree, TheQualityVetoLeavesNoSlivers) {
  const MergeTree tree =
      build_merge_tree(sphere(4), {.order = CollapseOrder::kLength, .smallest_quality = 0.3});
  const std::vector<bool> is_full = full_triangles(tree);
  for (std::size_t t = 0; t < tree.triangles.size(); ++t) {
    if (is_full[t]) continue;
    const auto& [a, b, c] = tree.triangles[t];
    const Eigen::Vector3d u = (tree.place(b) - tree.place(a)).cast<double>(),
                          v = (tree.place(c) - tree.place(b)).cast<double>(),
                          w = (tree.place(a) - tree.place(c)).cast<double>();
    const double area = u.cross(w).norm() / 2;
    EXPECT_GE(4 * std::sqrt(3) * area / (u.squaredNorm() + v.squaredNorm() + w.squaredNorm()),
              0.2999);
  }
}

TEST(BuildMergeTree, APlaneHasNoErrorAndComesDownToItsCorners) {
  const SurfaceMesh plane = sheet(33, 33, [](double x, double y) { return x / 2 + y / 4; });
  const MergeTree tree = build_merge_tree(plane, {.fewest_vertices = 4});
  EXPECT_EQ(tree.coarsest_points, 4U);
  EXPECT_EQ(tree.coarsest_triangles, 2U);
  for (const MergeBounds& bounds : tree.bounds) EXPECT_LT(bounds.error, 1e-5);
}

TEST(MergeTreeOf, ALevelSequenceHasThreeChildrenAParentAndTheSameFinestMesh) {
  const LevelSequence sequence = build_levels(torus(50, 20));
  const MergeTree tree = merge_tree_of(sequence);
  std::size_t collapses = 0;
  for (const auto& level : sequence.levels) collapses += level.size();
  EXPECT_EQ(tree.merge_count(), collapses);
  EXPECT_EQ(tree.level_count(), sequence.level_count());
  for (const Merge& merge : tree.merges) EXPECT_EQ(merge.child_count, 3U);
  EXPECT_TRUE(shape_of_mesh(mesh_of(tree, full_mesh_triangles(tree))) ==
              shape_of_mesh(mesh_at(sequence, 0)));
}

TEST(BuildMergeTree, ColoursStayWithTheirVerticesAndRangesHoldThem) {
  const SurfaceMesh mesh = painted(sphere(3));
  const MergeTree tree = build_merge_tree(mesh);
  ASSERT_EQ(tree.colours.size(), tree.points.size());
  // vertex by vertex: the tree's places are those of the mesh, to half a step
  for (std::uint32_t v = 0; v < tree.points.size(); ++v) {
    const Eigen::Vector3d p = tree.lattice.origin() + tree.lattice.relative(tree.points[v]);
    const auto same = std::ranges::find_if(mesh.points, [&](const Eigen::Vector3d& q) {
      return (p - q).cwiseAbs().maxCoeff() <= tree.lattice.step() / 2;
    });
    ASSERT_NE(same, mesh.points.end());
    EXPECT_EQ(tree.colours[v], mesh.colours[same - mesh.points.begin()]);
  }
  for (std::uint32_t i = 0; i < tree.merge_count(); ++i) {
    for (std::uint32_t t = tree.merges[i].fine_begin; t < tree.merges[i].fine_end; ++t) {
      for (const std::uint32_t a : tree.triangles[t]) {
        for (const std::uint32_t b : tree.triangles[t]) {
          const double step = std::abs(tree.colours[a][0] - tree.colours[b][0]) / 255.0;
          EXPECT_GE(tree.bounds[i].colour, step);
        }
      }
    }
    for (const std::uint32_t f : tree.finer(i)) {
      EXPECT_GE(tree.bounds[i].all_colour, tree.bounds[f].all_colour);
    }
  }
}

TEST(BuildMergeTree, RefusesSettingsOutOfRange) {
  EXPECT_THROW(build_merge_tree(sphere(1), {.share = 0}), ConfigError);
  EXPECT_THROW(build_merge_tree(sphere(1), {.smallest_quality = 1}), ConfigError);
}

}  // namespace
}  // namespace terrane::hierarchy

#include "hierarchy/levels/build_levels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.h"
#include "core/progress.h"
#include "hierarchy/levels/check_surface.h"
#include "hierarchy/levels/level_error.h"
#include "tests/hierarchy/levels/test_surfaces.h"

namespace terrane::hierarchy {
namespace {

using testing::mesh_at;
using testing::Oracle;

/// A small mesh of one of many kinds: open or closed, genus 0 to 2, up to three more boundaries.
SurfaceMesh random_mesh(unsigned seed) {
  std::mt19937 random(seed);
  const auto up_to = [&](std::uint32_t most) {
    return static_cast<std::uint32_t>(random() % (most + 1));
  };
  SurfaceMesh mesh;
  switch (seed % 4) {
    case 0:
      mesh = testing::sheet(4 + up_to(4), 4 + up_to(4),
                            [](double x, double y) { return 0.3 * x * y; });
      testing::jitter(mesh, 0.05, random);
      break;
    case 1:
      mesh = testing::torus(5 + up_to(3), 4 + up_to(3));
      testing::jitter(mesh, 0.02, random);
      break;
    default:
      mesh = testing::Slab(static_cast<int>(up_to(2)), 1 + static_cast<int>(seed % 4 == 3)).mesh();
      testing::jitter(mesh, 0.1, random);
  }
  testing::pierce(mesh, static_cast<int>(up_to(3)), random);
  NoProgress progress;
  return check_surface(mesh, "random", progress);
}

class RandomMeshes : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomMeshes, StayManifoldWithTheirEulerCharacteristicAtEveryLevel) {
  int collapses = 0;
  for (unsigned seed = GetParam(); seed < GetParam() + 200; ++seed) {
    const SurfaceMesh finest = random_mesh(seed);
    LevelOptions options{.weights = seed % 3 == 0 ? kCraterLakeWeights : kStHelensWeights,
                         .share = 0.06,
                         .rules = seed % 2 == 0 ? Rules::kTightened : Rules::kPublished,
                         .most_levels = 6,
                         .jobs = 1};
    const LevelSequence sequence = build_levels(finest, options);
    LevelRebuilder rebuilder(sequence);
    std::vector<std::vector<Corners>> levels{rebuilder.triangles()};
    while (rebuilder.level() > 0) {
      collapses += static_cast<int>(sequence.levels[rebuilder.level() - 1].size());
      rebuilder.refine();
      levels.push_back(rebuilder.triangles());
    }
    // M_0 itself, with the vertices where fans meet taken apart
    const Oracle first(levels.back());
    ASSERT_TRUE(first.is_manifold) << "seed " << seed;
    for (const auto& triangles : levels) {
      const Oracle oracle(triangles);
      ASSERT_TRUE(oracle.is_manifold) << "seed " << seed;
      ASSERT_EQ(oracle.euler, first.euler) << "seed " << seed;
    }
  }
  EXPECT_GT(collapses, 500);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomMeshes, ::testing::Range(0U, 3000U, 200U));

TEST(BuildLevels, EachInnerCollapseRemovesFourTriangles) {
  const SurfaceMesh torus = testing::torus(40, 20);
  const LevelSequence sequence = build_levels(torus, {.most_levels = 8});
  for (std::uint32_t i = 0; i < sequence.level_count(); ++i) {
    EXPECT_EQ(mesh_at(sequence, i).triangles.size() - mesh_at(sequence, i + 1).triangles.size(),
              4 * sequence.levels[i].size());
  }
}

TEST(BuildLevels, ATorusStaysAClosedTorus) {
  const LevelSequence sequence =
      build_levels(testing::torus(50, 50), {.weights = kCraterLakeWeights, .most_levels = 20});
  const Oracle last(sequence.coarsest_triangles);
  EXPECT_LT(sequence.coarsest_triangles.size(), 900U);
  EXPECT_TRUE(last.is_manifold);
  EXPECT_EQ(last.euler, 0);
  EXPECT_EQ(last.border_edges, 0);
}

TEST(BuildLevels, ASaddleKeepsItsCornersAndItsBorderInPlace) {
  const SurfaceMesh finest = testing::saddle(41, 33);
  const LevelSequence sequence = build_levels(finest, {.most_levels = 25});
  const SurfaceMesh last = mesh_at(sequence, sequence.level_count());
  ASSERT_LT(last.triangles.size(), finest.triangles.size() / 8);
  std::set<std::pair<double, double>> corners;
  for (const Eigen::Vector3d& p : last.points) {
    if (std::abs(p.x()) == 1 && std::abs(p.y()) == 1) corners.insert({p.x(), p.y()});
    EXPECT_LE(std::abs(p.x()), 1);
    EXPECT_LE(std::abs(p.y()), 1);
  }
  EXPECT_EQ(corners.size(), 4U);
  double area = 0;
  for (const auto& [a, b, c] : last.triangles) {
    const Eigen::Vector3d p = last.points[b] - last.points[a], q = last.points[c] - last.points[a];
    const double own = (p.x() * q.y() - p.y() * q.x()) / 2;
    EXPECT_GT(own, 0) << "folded in plan";
    area += own;
  }
  EXPECT_NEAR(area, 4, 1e-12) << "of the square that it stands over";
  const auto error = LevelErrorMeter(sequence).measure(last, sequence.level_count());
  ASSERT_TRUE(error.vertical);
  EXPECT_EQ(error.vertical->uncovered, 0U);
  EXPECT_LT(error.vertical->max, 0.2);
}

TEST(BuildLevels, ACornerTriangleCollapsesOntoItsCorner) {
  // the corner at (1, 1) belongs to one triangle alone: two border edges meet in it (type 3)
  SurfaceMesh mesh = testing::sheet(9, 9, [](double, double) { return 0.0; });
  for (std::size_t t = 0; t + 1 < mesh.triangles.size(); t += 2) {
    const auto [a, b, c] = mesh.triangles[t];
    const std::uint32_t d = mesh.triangles[t + 1][2];
    mesh.triangles[t] = {a, b, d};
    mesh.triangles[t + 1] = {b, c, d};
  }
  const LevelSequence sequence =
      build_levels(mesh, {.share = 1, .rules = Rules::kPublished, .most_levels = 3});
  int onto_corner = 0;
  for (const auto& level : sequence.levels) {
    for (const Collapse& collapse : level) {
      const auto outside = std::ranges::count(collapse.apexes, kOutside);
      if (outside != 2) continue;
      ++onto_corner;
      EXPECT_EQ(collapse.after, collapse.before[0]);
      EXPECT_EQ(collapse.apexes[0], kOutside) << "both edges at the corner are on the border";
      EXPECT_EQ(collapse.apexes[2], kOutside);
    }
  }
  EXPECT_GT(onto_corner, 0);
}

TEST(BuildLevels, OneThreadAndManyGiveTheSameSequence) {
  const SurfaceMesh finest = testing::saddle(61, 47);
  for (const Weights& weights : {kStHelensWeights, kCraterLakeWeights}) {
    const LevelSequence one = build_levels(finest, {.weights = weights, .jobs = 1});
    const LevelSequence many = build_levels(finest, {.weights = weights, .jobs = 4});
    EXPECT_EQ(one.levels, many.levels);
    EXPECT_EQ(one.coarsest_triangles, many.coarsest_triangles);
  }
}

TEST(BuildLevels, StencilsOfOneLevelDoNotMeet) {
  const LevelSequence sequence = build_levels(testing::torus(30, 20), {.share = 1});
  for (std::uint32_t i = 0; i < sequence.level_count(); ++i) {
    const SurfaceMesh mesh = mesh_at(sequence, i);
    std::set<std::uint32_t> seen;
    for (const Collapse& collapse : sequence.levels[i]) {
      for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const bool is_in_stencil = std::ranges::any_of(mesh.triangles[t], [&](std::uint32_t v) {
          return std::ranges::find(collapse.corners, v) != collapse.corners.end();
        });
        if (is_in_stencil) {
          EXPECT_TRUE(seen.insert(t).second) << "level " << i;
        }
      }
    }
  }
}

TEST(BuildLevels, FlatTrianglesCollapseFirst) {
  // flat but for a bump in one corner
  const SurfaceMesh finest = testing::sheet(41, 41, [](double x, double y) {
    const double r2 = (x - 0.6) * (x - 0.6) + (y - 0.6) * (y - 0.6);
    return 0.3 * std::exp(-r2 / 0.02);
  });
  const LevelSequence sequence = build_levels(finest, {.most_levels = 1});
  for (const Collapse& collapse : sequence.levels.front()) {
    const Eigen::Vector3d c = sequence.lattice.origin() + sequence.lattice.relative(collapse.after);
    EXPECT_GT((c - Eigen::Vector3d(0.6, 0.6, c.z())).norm(), 0.2);
  }
}

TEST(BuildLevels, RefusesOptionsOutOfRange) {
  const SurfaceMesh mesh = testing::torus(8, 8);
  EXPECT_THROW(build_levels(mesh, {.weights = {.curvature = 1.5}}), ConfigError);
  EXPECT_THROW(build_levels(mesh, {.share = 0}), ConfigError);
  EXPECT_THROW(build_levels(mesh, {.share = 1.01}), ConfigError);
  EXPECT_THROW(build_levels(mesh, {.jobs = -1}), ConfigError);
}

TEST(BuildLevels, EndsWhereItIsTold) {
  const SurfaceMesh mesh = testing::torus(20, 20);
  EXPECT_EQ(build_levels(mesh, {.most_levels = 0}).coarsest_triangles.size(), 800U);
  const LevelSequence few = build_levels(mesh, {.most_levels = 100, .fewest_triangles = 400});
  EXPECT_LE(few.coarsest_triangles.size(), 400U);
  EXPECT_GT(mesh_at(few, few.level_count() - 1).triangles.size(), 400U);
  const LevelSequence kept = build_levels(
      mesh, {.keep = [](const LevelStatistics& level) { return level.triangles > 600; }});
  EXPECT_GT(kept.coarsest_triangles.size(), 600U);
}

}  // namespace
}  // namespace terrane::hierarchy

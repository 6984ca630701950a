#include "hierarchy/collapse/strict_collapse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/hierarchy/test_meshes.h"

namespace terrane::hierarchy {
namespace {

using testing::ExactPlacer;
using testing::field_of;
using testing::grid_of;
using testing::terrain_of;

struct PlainError {
  double max_m = 0;
  int uncovered = 0;
  int folded = 0;
};

/// Tries every triangle for every sample, with barycentric coordinates: slow, and nothing shared
/// with the code under test.
PlainError brute_force_error(const TerrainMesh& mesh, const HeightGrid& grid) {
  PlainError result;
  std::vector<double> worst(grid.heights_m.size(), -1);
  for (const Corners& corners : mesh.triangles) {
    double x[3], y[3], z[3];
    for (int k = 0; k < 3; ++k) {
      const Place& place = mesh.vertices[corners[k]].place;
      x[k] = place.plan.x / double{kUnitsPerCell};
      y[k] = -place.plan.y / double{kUnitsPerCell};
      z[k] = place.height_m;
    }
    const double area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    if (area >= 0) ++result.folded;  // rows run downward: counter-clockwise on the map is negative
    for (std::int64_t row = 0; row < grid.window.rows; ++row) {
      for (std::int64_t column = 0; column < grid.window.columns; ++column) {
        const auto c = static_cast<double>(column), r = static_cast<double>(row);
        const double w1 = ((c - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (r - y[0])) / area;
        const double w2 = ((x[1] - x[0]) * (r - y[0]) - (c - x[0]) * (y[1] - y[0])) / area;
        if (w1 < -1e-9 || w2 < -1e-9 || w1 + w2 > 1 + 1e-9) continue;
        const double on_mesh = z[0] + w1 * (z[1] - z[0]) + w2 * (z[2] - z[0]);
        double& error = worst[static_cast<std::size_t>(row * grid.window.columns + column)];
        error = std::max(error, std::abs(on_mesh - grid.at(column, row)));
      }
    }
  }
  for (std::size_t i = 0; i < worst.size(); ++i) {
    if (std::isnan(grid.heights_m[i])) continue;
    if (worst[i] < 0) ++result.uncovered;
    result.max_m = std::max(result.max_m, worst[i]);
  }
  return result;
}

StrictResult collapse(const HeightGrid& grid, double tolerance_m) {
  const ExactPlacer placer;
  const SampleField field = field_of(grid);
  return collapse_strictly(terrain_of(grid), field, placer, {}, {.tolerance_m = tolerance_m});
}

TEST(StrictCollapse, PlaneBecomesAHandfulOfTriangles) {
  const HeightGrid grid = grid_of(33, 33, [](auto c, auto r) { return 2.0 * c + 0.5 * r; });
  const StrictResult result = collapse(grid, 0.01);
  EXPECT_LE(result.mesh.triangles.size(), 16U);
  const PlainError error = brute_force_error(result.mesh, grid);
  EXPECT_LE(error.max_m, 0.01);
  EXPECT_EQ(error.uncovered, 0);
}

TEST(StrictCollapse, KeepsASpikeThatIsHigherThanTheTolerance) {
  const HeightGrid grid = grid_of(17, 17, [](auto c, auto r) { return c == 9 && r == 6 ? 50 : 0; });
  const StrictResult result = collapse(grid, 5);
  EXPECT_LE(brute_force_error(result.mesh, grid).max_m, 5);
}

TEST(StrictCollapse, TargetsLeadToVerticesOfTheResult) {
  const HeightGrid grid = grid_of(9, 9, [](auto c, auto r) { return c * r; });
  const StrictResult result = collapse(grid, 2);
  ASSERT_EQ(result.target.size(), 81U);
  for (const std::uint32_t v : result.target) EXPECT_LT(v, result.mesh.vertices.size());
}

TEST(StrictCollapse, LockedVerticesStayWhereTheyAre) {
  const HeightGrid grid = grid_of(9, 9, [](auto, auto) { return 0; });
  TerrainMesh input = terrain_of(grid);
  for (TerrainVertex& vertex : input.vertices) {
    if (vertex.kind == VertexKind::kOutline) vertex.kind = VertexKind::kLocked;
  }
  const ExactPlacer placer;
  const SampleField field = field_of(grid);
  const StrictResult result = collapse_strictly(input, field, placer, {}, {.tolerance_m = 1});
  for (std::uint32_t v = 0; v < input.vertices.size(); ++v) {
    if (input.vertices[v].kind != VertexKind::kLocked) continue;
    EXPECT_EQ(result.mesh.vertices[result.target[v]].place.plan, input.vertices[v].place.plan);
  }
}

double steepest_m(const TerrainMesh& mesh) {
  double steepest_m = 0;
  for (const Corners& corners : mesh.triangles) {
    double x[3], y[3], z[3];
    for (int k = 0; k < 3; ++k) {
      const Place& place = mesh.vertices[corners[k]].place;
      x[k] = column_of(place.plan) - column_of(mesh.vertices[corners[0]].place.plan);
      y[k] = row_of(place.plan) - row_of(mesh.vertices[corners[0]].place.plan);
      z[k] = place.height_m - mesh.vertices[corners[0]].place.height_m;
    }
    const double area = x[1] * y[2] - x[2] * y[1];
    steepest_m = std::max(steepest_m, std::hypot((z[1] * y[2] - z[2] * y[1]) / area,
                                                 (x[1] * z[2] - x[2] * z[1]) / area));
  }
  return steepest_m;
}

TEST(StrictCollapse, MakesNoTriangleSteeperThanAskedFor) {
  std::mt19937 random(1);
  const HeightGrid grid =
      grid_of(40, 40, [&](auto, auto) { return static_cast<double>(random() % 100); });
  const TerrainMesh full = terrain_of(grid);
  const double wanted_m = steepest_m(full);
  ASSERT_GT(steepest_m(collapse(grid, 25).mesh), wanted_m) << "or this shows nothing";
  const StrictResult result =
      collapse_strictly(full, field_of(grid), ExactPlacer(), {},
                        {.tolerance_m = 25, .shape = {.steepest_m = wanted_m}, .effort = 3});
  EXPECT_LE(steepest_m(result.mesh), wanted_m);
  EXPECT_LT(result.mesh.triangles.size(), full.triangles.size() / 2);
}

/// The finer mesh on its way to the coarser one.
TerrainMesh blend(const TerrainMesh& finer, const StrictResult& coarser, double t) {
  TerrainMesh mesh = finer;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const Place& to = coarser.mesh.vertices[coarser.target[v]].place;
    Place& place = mesh.vertices[v].place;
    place.plan.x += static_cast<std::int32_t>(std::lround(t * (to.plan.x - place.plan.x)));
    place.plan.y += static_cast<std::int32_t>(std::lround(t * (to.plan.y - place.plan.y)));
    place.height_m += t * (to.height_m - place.height_m);
  }
  return mesh;
}

TEST(StrictCollapse, AboveLevel0EachEffortBlendsSoundlyAndNeedsNoMoreTriangles) {
  std::mt19937 random(7);
  const HeightGrid grid = grid_of(49, 49, [&](auto c, auto r) {
    return 20 * std::sin(0.3 * static_cast<double>(c)) * std::cos(0.23 * static_cast<double>(r)) +
           2 * static_cast<double>(random()) / 4294967296.0;
  });
  const TerrainMesh level0 = collapse(grid, 1).mesh;
  FinerLevel finer{.places = {}, .triangles = level0.triangles, .target = {}};
  for (const TerrainVertex& vertex : level0.vertices) finer.places.push_back(vertex.place);

  std::size_t triangles = level0.triangles.size();
  for (const int effort : {0, 1, 3}) {
    const StrictResult level1 = collapse_strictly(level0, field_of(grid), ExactPlacer(), finer,
                                                  {.tolerance_m = 2, .effort = effort});
    EXPECT_LT(level1.mesh.triangles.size(), triangles) << "effort " << effort;
    triangles = level1.mesh.triangles.size();
    for (const double t : {0.1, 0.25, 0.5, 0.75, 0.9}) {
      const PlainError error = brute_force_error(blend(level0, level1, t), grid);
      // places on the way are rounded to 1/16,384 cell
      EXPECT_LE(error.max_m, 2 + 0.01) << "effort " << effort << " at " << t;
      EXPECT_EQ(error.folded, 0) << "effort " << effort << " at " << t;
    }
    EXPECT_LE(brute_force_error(level1.mesh, grid).max_m, 2 + 1e-9) << "effort " << effort;
  }
}

class RandomTerrain : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomTerrain, StaysWithinTheBoundCoversEverySampleAndFoldsNothing) {
  std::mt19937 random(GetParam());
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  const auto columns = static_cast<std::int64_t>(uniform(2, 30));
  const auto rows = static_cast<std::int64_t>(uniform(2, 30));
  const double relief_m = uniform(0, 40), roughness_m = uniform(0, 6), holes = uniform(0, 0.06);
  const bool has_cliff = random() % 2 == 0;
  const HeightGrid grid = grid_of(columns, rows, [&](auto c, auto r) {
    if (uniform(0, 1) < holes) return static_cast<double>(NAN);
    const double hill =
        relief_m * std::sin(0.3 * static_cast<double>(c)) * std::cos(0.23 * static_cast<double>(r));
    return hill + uniform(0, roughness_m) + (has_cliff && c > r ? 60.0 : 0.0);
  });
  const TerrainMesh full = terrain_of(grid);
  if (full.triangles.empty()) GTEST_SKIP() << "the dice made no triangle";
  const PlainError before = brute_force_error(full, grid);
  const double tolerance_m = uniform(0.5, 12);

  const StrictResult result = collapse(grid, tolerance_m);

  const PlainError after = brute_force_error(result.mesh, grid);
  EXPECT_LE(after.max_m, tolerance_m + 1e-9);
  EXPECT_EQ(after.uncovered, before.uncovered);  // samples without a triangle to begin with
  EXPECT_EQ(after.folded, 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomTerrain, ::testing::Range(0U, 300U));

TEST(StrictCollapse, WhatIsMarkedAsWaterStaysOnItsSideOfTheShore) {
  // columns 0 to 12 are water, the shore runs along column 12; all is flat
  const HeightGrid grid = grid_of(25, 25, [](auto, auto) { return 0; });
  TerrainMesh input = terrain_of(grid);
  const auto column = [](const TerrainMesh& mesh, std::uint32_t v) {
    return mesh.vertices[v].place.plan.x / double{kUnitsPerCell};
  };
  for (const Corners& corners : input.triangles) {
    const bool is_wet =
        std::ranges::all_of(corners, [&](std::uint32_t v) { return column(input, v) <= 12; });
    input.in_water.push_back(is_wet ? 1 : 0);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = corners[k], b = corners[(k + 1) % 3];
      if (a < b && column(input, a) == 12 && column(input, b) == 12) input.lines.push_back({a, b});
    }
  }
  for (const LineEdge& edge : input.lines) {
    for (const std::uint32_t v : edge) {
      VertexKind& kind = input.vertices[v].kind;
      kind = kind == VertexKind::kOutline ? VertexKind::kLocked : VertexKind::kFeature;
    }
  }
  const ExactPlacer placer;
  const SampleField field = field_of(grid);
  const TerrainMesh mesh =
      collapse_strictly(input, field, placer, {},
                        {.tolerance_m = 1, .effort = kTopEffort, .lines = {0.1, 1, 1}})
          .mesh;
  EXPECT_LT(mesh.triangles.size(), input.triangles.size() / 10);
  ASSERT_EQ(mesh.in_water.size(), mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      if (mesh.in_water[t] == 1) {
        EXPECT_LE(column(mesh, v), 12);
      } else {
        EXPECT_GE(column(mesh, v), 12);
      }
    }
  }
}

}  // namespace
}  // namespace terrane::hierarchy

#include "hierarchy/mesh/lined_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "../test_meshes.h"

namespace terrane::hierarchy {
namespace {

using testing::grid_of;

HeightGrid slope() {
  return grid_of(6, 5, [](auto c, auto r) { return 10.0 * c + r; });
}

GridPoint plan_of(const LinedTriangles& mesh, std::uint32_t v) {
  if (v >= mesh.samples.size()) return mesh.line_vertices[v - mesh.samples.size()].plan;
  return {mesh.samples[v].column * kUnitsPerCell, -mesh.samples[v].row * kUnitsPerCell};
}

/// Twice the area of all triangles in cells; each must be counter-clockwise.
double twice_area_cells(const LinedTriangles& mesh) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::int64_t twice = orient2d(plan_of(mesh, a), plan_of(mesh, b), plan_of(mesh, c));
    EXPECT_GT(twice, 0);
    area += static_cast<double>(twice);
  }
  return area / kUnitsPerCell / kUnitsPerCell;
}

/// No two triangles on one side of an edge, and every line edge is a side of two triangles.
void expect_conforming(const LinedTriangles& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> sides;
  for (const Corners& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(sides.insert({t[k], t[(k + 1) % 3]}).second);
  }
  for (const auto& [a, b] : mesh.edges) {
    EXPECT_EQ(sides.count({a, b}) + sides.count({b, a}), 2U);
  }
}

double length_of(const LinedTriangles& mesh) {
  double length = 0;
  for (const auto& [a, b] : mesh.edges) {
    const GridPoint p = plan_of(mesh, a), q = plan_of(mesh, b);
    length += std::hypot(static_cast<double>(p.x) - q.x, static_cast<double>(p.y) - q.y);
  }
  return length / kUnitsPerCell;
}

TEST(TriangulateWithLines, WithoutLinesGivesThePlainMesh) {
  const HeightGrid grid = slope();
  const LinedTriangles mesh = triangulate_with_lines(grid, grid.window, {});
  EXPECT_EQ(mesh.triangles, triangulate(grid, grid.window).triangles);
  EXPECT_TRUE(mesh.line_vertices.empty());
}

TEST(TriangulateWithLines, ALineAcrossCellsBecomesEdgesOnTheSlope) {
  const HeightGrid grid = slope();
  const FeatureLine line{{{1.25, 1.5}, {2, 1.5}, {2.5, 1.5}, {3, 1.5}, {3.5, 2}, {3.75, 2.25}}, {}};
  const LinedTriangles mesh = triangulate_with_lines(grid, grid.window, {&line, 1});
  EXPECT_EQ(mesh.samples.size(), 30U);
  EXPECT_EQ(mesh.line_vertices.size(), 6U);
  EXPECT_NEAR(length_of(mesh), 1.75 + std::hypot(0.75, 0.75), 1e-12);
  EXPECT_EQ(twice_area_cells(mesh), 2 * 5 * 4);
  expect_conforming(mesh);
  for (const LineVertex& v : mesh.line_vertices) {
    EXPECT_NEAR(v.height_m, 10 * column_of(v.plan) + row_of(v.plan), 1e-12);
  }
}

TEST(TriangulateWithLines, AShoreHasTheHeightOfItsWaterAlsoWhereALineCrossesIt) {
  const HeightGrid grid = slope();
  const FeatureLine lines[] = {{{{1.25, 1.25}, {1.75, 1.75}}, {}},
                               {{{1.25, 1.75}, {1.75, 1.25}}, 3.5}};
  const LinedTriangles mesh = triangulate_with_lines(grid, grid.window, lines);
  ASSERT_EQ(mesh.line_vertices.size(), 5U);
  int wet = 0;
  for (const LineVertex& v : mesh.line_vertices) wet += v.height_m == 3.5;
  EXPECT_EQ(wet, 3);
  expect_conforming(mesh);
}

TEST(TriangulateWithLines, ARingInsideOneCellIsKept) {
  const HeightGrid grid = slope();
  const FeatureLine ring{{{2.25, 2.25}, {2.75, 2.25}, {2.5, 2.75}, {2.25, 2.25}}, 1.0};
  const LinedTriangles mesh = triangulate_with_lines(grid, grid.window, {&ring, 1});
  EXPECT_EQ(mesh.edges.size(), 3U);
  EXPECT_EQ(twice_area_cells(mesh), 2 * 5 * 4);
  expect_conforming(mesh);
}

TEST(TriangulateWithLines, ALineAlongSamplesTakesTheirVertices) {
  const HeightGrid grid = slope();
  const FeatureLine line{{{1, 1}, {2, 1}, {3, 2}}, {}};
  const LinedTriangles mesh = triangulate_with_lines(grid, grid.window, {&line, 1});
  EXPECT_TRUE(mesh.line_vertices.empty());
  EXPECT_EQ(mesh.edges.size(), 2U);
  EXPECT_EQ(mesh.triangles.size(), 40U);
}

TEST(TriangulateWithLines, ALineEndsOnTheDiagonalBeyondWhichASampleIsMissing) {
  const HeightGrid grid =
      grid_of(6, 5, [](auto c, auto r) { return c == 3 && r == 2 ? double{NAN} : 0.0; });
  // through the cell of (2, 1), whose last sample is void: its triangle ends on column + row = 4
  const FeatureLine line{{{2, 1.25}, {3, 1.75}}, {}};
  const LinedTriangles mesh = triangulate_with_lines(grid, grid.window, {&line, 1});
  ASSERT_EQ(mesh.edges.size(), 1U);
  ASSERT_EQ(mesh.line_vertices.size(), 2U);
  const GridPoint end = mesh.line_vertices[1].plan.x > mesh.line_vertices[0].plan.x
                            ? mesh.line_vertices[1].plan
                            : mesh.line_vertices[0].plan;
  EXPECT_EQ(end.x - end.y, 4 * kUnitsPerCell);
  EXPECT_NEAR(column_of(end), 2.5, 1e-4);
  EXPECT_EQ(twice_area_cells(mesh), 2 * 20 - 8 + 4);
}

TEST(TriangulateWithLines, ALineOutsideTheDataIsLeftOut) {
  const HeightGrid grid = slope();
  const FeatureLine line{{{-1, 1.5}, {0, 1.5}}, {}};
  EXPECT_TRUE(triangulate_with_lines(grid, grid.window, {&line, 1}).edges.empty());
}

TEST(TriangulateWithLines, TwoWindowsThatShareABorderHaveTheSameVerticesOnIt) {
  const HeightGrid grid = grid_of(9, 5, [](auto c, auto r) { return 10.0 * c + r * r; });
  // crosses column 4, touches it from the right alone, and runs along it
  const std::vector<FeatureLine> lines{
      {{{3.5, 0.5}, {4, 0.75}, {4.5, 1}}, {}},
      {{{4.5, 1.25}, {4, 1.5}, {4.5, 1.75}}, 7.0},
      {{{4, 2}, {4, 2.5}, {4, 3}}, {}},
  };
  const Window sides[] = {{0, 0, 5, 5}, {4, 0, 5, 5}};
  std::set<std::tuple<double, double, double>> on_border[2];
  for (int k = 0; k < 2; ++k) {
    const LinedTriangles mesh = triangulate_with_lines(grid, sides[k], lines);
    const std::vector<BorderPlace> places = places_of(mesh, sides[k]);
    for (std::size_t v = mesh.samples.size(); v < places.size(); ++v) {
      if (places[v].column != 4) continue;
      on_border[k].emplace(places[v].column, places[v].row,
                           mesh.line_vertices[v - mesh.samples.size()].height_m);
    }
  }
  EXPECT_EQ(on_border[0].size(), 3U);
  EXPECT_EQ(on_border[0], on_border[1]);
  EXPECT_TRUE(on_border[0].count({4, 1.5, 7}));
}

TEST(TriangulateWithLines, ALineThatGoesIntoWaterBesideItsShoreIsAsHighAsTheWater) {
  // water at 0 m beyond the shore at column 1.25; samples on land are 10 m high
  const HeightGrid grid = grid_of(4, 4, [](auto c, auto) { return c < 2 ? 10.0 : 0.0; });
  FeatureLine shore{{}, 0.0};
  for (double row = 0; row <= 3; ++row) shore.points.push_back({1.25, row});
  // bends in the shore's cell, and passes the side of the next cell in between
  const FeatureLine line{{{1, 1.25}, {1.25, 1.375}, {1.5, 1.5}, {1.625, 2}, {1.75, 2.5}, {2, 2.5}},
                         {}};
  const FeatureLine lines[] = {shore, line};
  const auto water = [](const GridPosition& p) {
    return p.column > 1.25 ? std::optional<double>(0) : std::nullopt;
  };
  const LinedTriangles mesh = triangulate_with_lines(grid, grid.window, lines, water);
  int in_water = 0;
  for (const LineVertex& vertex : mesh.line_vertices) {
    if (column_of(vertex.plan) < 1.25) continue;
    EXPECT_EQ(vertex.height_m, 0) << column_of(vertex.plan);
    ++in_water;
  }
  EXPECT_GE(in_water, 4 + 3);
}

}  // namespace
}  // namespace terrane::hierarchy

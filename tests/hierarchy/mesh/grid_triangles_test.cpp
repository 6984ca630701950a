#include "hierarchy/mesh/grid_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "hierarchy/mesh/grid_point.h"
#include "tests/hierarchy/test_meshes.h"

namespace terrane::hierarchy {
namespace {

using testing::grid_of;

/// Does a triangle hold all three of these samples?
bool has_triangle(const GridTriangles& mesh, SampleId a, SampleId b, SampleId c) {
  return std::ranges::any_of(mesh.triangles, [&](const Corners& corners) {
    const auto holds = [&](SampleId s) {
      return std::ranges::any_of(corners, [&](std::uint32_t v) { return mesh.vertices[v] == s; });
    };
    return holds(a) && holds(b) && holds(c);
  });
}

TEST(GridTriangles, EveryFullCellGivesTwo) {
  const HeightGrid grid = grid_of(5, 4, [](auto, auto) { return 1; });
  EXPECT_EQ(triangulate(grid, grid.window).triangles.size(), 2U * 4 * 3);
}

TEST(GridTriangles, ACellWithThreeHeightsGivesOneAndWithTwoNone) {
  const HeightGrid three = grid_of(2, 2, [](auto c, auto r) { return c + r == 0 ? NAN : 1; });
  EXPECT_EQ(triangulate(three, three.window).triangles.size(), 1U);
  const HeightGrid two = grid_of(2, 2, [](auto c, auto) { return c == 0 ? NAN : 1; });
  EXPECT_TRUE(triangulate(two, two.window).triangles.empty());
  EXPECT_TRUE(triangulate(two, two.window).vertices.empty());
}

TEST(GridTriangles, BorderEdgesOfACornerCellDoNotShareATriangle) {
  const HeightGrid grid = grid_of(4, 3, [](auto, auto) { return 1; });
  const GridTriangles mesh = triangulate(grid, grid.window);
  EXPECT_FALSE(has_triangle(mesh, {0, 1}, {0, 0}, {1, 0}));
  EXPECT_FALSE(has_triangle(mesh, {2, 0}, {3, 0}, {3, 1}));
  EXPECT_FALSE(has_triangle(mesh, {0, 1}, {0, 2}, {1, 2}));
  EXPECT_FALSE(has_triangle(mesh, {2, 2}, {3, 2}, {3, 1}));
}

TEST(GridTriangles, AreCounterClockwiseOnTheMap) {
  const HeightGrid grid =
      grid_of(6, 6, [](auto c, auto r) { return (c * 7 + r * 5) % 11 == 0 ? NAN : 1; });
  const GridTriangles mesh = triangulate(grid, grid.window);
  ASSERT_FALSE(mesh.triangles.empty());
  for (const Corners& corners : mesh.triangles) {
    const auto at = [&](int k) {
      const SampleId s = mesh.vertices[corners[k]];
      return GridPoint{s.column, -s.row};
    };
    EXPECT_EQ(orient2d(at(0), at(1), at(2)), 1);
  }
}

}  // namespace
}  // namespace terrane::hierarchy

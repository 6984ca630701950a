#include "hierarchy/mesh/stencil.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/hierarchy/test_meshes.h"

namespace terrane::hierarchy {
namespace {

using testing::triangles_of;

TEST(Stencil, PolygonOfAnInnerGridTriangleHasNineVertices) {
  // three corners of valence 6, two of them neighbours of each other twice: 3 * 6 - 9
  const HalfedgeMesh mesh(64, triangles_of(8, 8));
  StencilWalker walker(mesh);
  Stencil stencil;
  ASSERT_EQ(walker.around_triangle(TriangleId{2 * (3 * 7 + 3)}, stencil), Collapsibility::kYes);
  EXPECT_EQ(stencil.polygon.size(), 9U);
  EXPECT_EQ(stencil.spokes.size(), 9U);
}

TEST(Stencil, PolygonOfAnInnerGridEdgeHasEightVertices) {
  const HalfedgeMesh mesh(64, triangles_of(8, 8));
  StencilWalker walker(mesh);
  Stencil stencil;
  ASSERT_EQ(walker.around_edge(HalfedgeMesh::halfedge(TriangleId{2 * (3 * 7 + 3)}, 0), stencil),
            Collapsibility::kYes);
  EXPECT_EQ(stencil.polygon.size(), 8U);
}

TEST(Stencil, OfATriangleWithAValenceThreeCornerIsCyclic) {
  // vertex 3 in the middle of a triangle
  const HalfedgeMesh mesh(4, std::vector<Corners>{{0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
  StencilWalker walker(mesh);
  Stencil stencil;
  EXPECT_EQ(walker.around_triangle(TriangleId{0}, stencil), Collapsibility::kCyclic);
}

TEST(Stencil, OfATriangleWithANeighbourApexOfValenceFourIsRefused) {
  // a hexagon about triangle (0, 1, 2) whose neighbour apex 3 has four edges
  const HalfedgeMesh mesh(8, std::vector<Corners>{{0, 1, 2},
                                                  {1, 0, 3},
                                                  {2, 1, 4},
                                                  {0, 2, 5},
                                                  {0, 6, 3},
                                                  {3, 7, 1},
                                                  {3, 6, 7},
                                                  {1, 7, 4},
                                                  {0, 5, 6}});
  ASSERT_EQ(mesh.valence(VertexId{3}), 4U);
  StencilWalker walker(mesh);
  Stencil stencil;
  EXPECT_EQ(walker.around_triangle(TriangleId{0}, stencil), Collapsibility::kValence);
}

TEST(Stencil, OfATriangleAtACornerOfTheBorderIsCompleteWhereItMayCollapse) {
  // 5 x 5 samples whose last cell is cut across: one triangle holds both border edges at the corner
  std::vector<Corners> triangles = triangles_of(5, 5);
  std::erase_if(triangles, [](const Corners& t) {
    return std::ranges::count_if(
               t, [](auto v) { return v == 18 || v == 19 || v == 23 || v == 24; }) == 3;
  });
  const Corners corner{19, 23, 24};
  triangles.push_back({18, 23, 19});
  triangles.push_back(corner);
  HalfedgeMesh mesh(25, triangles);
  const TriangleId t{static_cast<std::uint32_t>(triangles.size()) - 1};
  Stencil stencil;
  EXPECT_EQ(StencilWalker(mesh).around_triangle(t, stencil), Collapsibility::kCyclic);
  ASSERT_EQ(StencilWalker(mesh, CornerTriangles::kMayCollapse).around_triangle(t, stencil),
            Collapsibility::kYes);
  mesh.collapse(stencil.spokes, stencil.dying_span(), VertexId{24});
  EXPECT_EQ(mesh.triangles().size(), triangles.size() - 2) << "two of the four were outside";
  EXPECT_TRUE(mesh.is_boundary(VertexId{24}));
}

TEST(Stencil, OfATriangleThatJoinsTwoPartsOfABoundaryIsRefused) {
  // a strip one cell wide: every triangle has corners on both sides
  const HalfedgeMesh mesh(12, triangles_of(6, 2));
  StencilWalker walker(mesh);
  Stencil stencil;
  EXPECT_NE(walker.around_triangle(TriangleId{4}, stencil), Collapsibility::kYes);
}

}  // namespace
}  // namespace terrane::hierarchy

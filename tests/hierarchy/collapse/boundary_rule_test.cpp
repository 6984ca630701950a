#include "hierarchy/collapse/boundary_rule.h"

#include <gtest/gtest.h>

#include "tests/hierarchy/test_meshes.h"

namespace terrane::hierarchy {
namespace {

using testing::ExactPlacer;
using testing::grid_of;
using testing::terrain_of;

/// 6 x 6 samples, vertex = 6 row + column.
class GridRule : public ::testing::Test {
 protected:
  GridRule() : mesh_(36, terrain_.triangles), walker_(mesh_) {}

  HalfedgeId edge(std::uint32_t from, std::uint32_t to) const {
    const HalfedgeId first = mesh_.outgoing(VertexId{from});
    HalfedgeId h = first;
    do {
      if (mesh_.end(h) == VertexId{to}) return h;
      h = mesh_.rotate(h);
    } while (h != first);
    ADD_FAILURE() << "no edge " << from << "-" << to;
    return h;
  }

  BoundaryVerdict of_edge(std::uint32_t from, std::uint32_t to) {
    Stencil stencil;
    EXPECT_EQ(walker_.around_edge(edge(from, to), stencil), Collapsibility::kYes);
    return classify(stencil, mesh_, terrain_.vertices, placer_);
  }

  TerrainMesh terrain_ = terrain_of(grid_of(6, 6, [](auto, auto) { return 0; }));
  HalfedgeMesh mesh_;
  StencilWalker walker_;
  ExactPlacer placer_;
};

TEST_F(GridRule, InnerEdgeIsFree) { EXPECT_EQ(of_edge(14, 15).type, BoundaryType::kInterior); }

TEST_F(GridRule, EdgeWithOneEndOnTheOutlineGoesToThatEnd) {
  const BoundaryVerdict verdict = of_edge(8, 2);
  EXPECT_EQ(verdict.type, BoundaryType::kVertex);
  EXPECT_EQ(verdict.onto, VertexId{2});
}

TEST_F(GridRule, StraightOutlineEdgeCollapsesAlongTheOutline) {
  const BoundaryVerdict verdict = of_edge(2, 3);
  EXPECT_EQ(verdict.type, BoundaryType::kEdge);
  EXPECT_TRUE(verdict.onto == VertexId{2} || verdict.onto == VertexId{3});
}

TEST_F(GridRule, OutlineEdgeAtTheDataSetsCornerKeepsTheCorner) {
  const BoundaryVerdict verdict = of_edge(0, 1);
  EXPECT_EQ(verdict.type, BoundaryType::kEdge);
  EXPECT_EQ(verdict.onto, VertexId{0});
}

TEST_F(GridRule, LockedVertexNeverGivesWay) {
  for (const std::uint32_t v : {2U, 3U}) terrain_.vertices[v].kind = VertexKind::kLocked;
  EXPECT_EQ(of_edge(2, 3).type, BoundaryType::kFixed);
  terrain_.vertices[3].kind = VertexKind::kOutline;
  EXPECT_EQ(of_edge(2, 3).onto, VertexId{2});
}

}  // namespace
}  // namespace terrane::hierarchy

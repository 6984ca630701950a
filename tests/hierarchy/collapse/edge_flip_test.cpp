#include "hierarchy/collapse/edge_flip.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/hierarchy/test_meshes.h"

namespace terrane::hierarchy {
namespace {

using testing::ExactPlacer;
using testing::field_of;
using testing::grid_of;

Place cell(int column, int row, double height_m) {
  return ExactPlacer().place({column * kUnitsPerCell, -row * kUnitsPerCell}, height_m);
}

/// A quad 4 cells wide with a ridge or valley along one diagonal, in a ring of triangles so that
/// each corner may lose an edge.
///
///      0─────3     edge 0-2 has the triangles 0 1 2 and 0 2 3
///      │ ╲   │
///      │   ╲ │
///      1─────2
class Quad {
 public:
  /// \param ridge_across  true: the ridge joins 1 and 3, across the edge.
  explicit Quad(bool ridge_across)
      : grid_(grid_of(9, 9, [&](auto c, auto r) { return height(c, r, ridge_across); })),
        field_(field_of(grid_)),
        mesh_(8, triangles()) {
    const int at[8][2] = {{2, 2}, {2, 6}, {6, 6}, {6, 2}, {0, 4}, {4, 8}, {8, 4}, {4, 0}};
    for (const auto& [c, r] : at) {
      vertices_.push_back({.place = cell(c, r, height(c, r, ridge_across))});
    }
  }

  bool is_better(double tolerance_m = 100) {
    const CoveredSamples samples(field_, vertices_, triangles(), mesh_.triangle_count());
    return flip_.is_better(HalfedgeMesh::halfedge(TriangleId{0}, 2), mesh_, vertices_, samples,
                           tolerance_m, {}, ExactPlacer());
  }
  TerrainVertex& vertex(std::size_t k) { return vertices_[k]; }

 private:
  static double height(std::int64_t c, std::int64_t r, bool ridge_across) {
    const auto x = static_cast<double>(c - 4), y = static_cast<double>(r - 4);
    return ridge_across ? -std::abs(x + y) : -std::abs(x - y);
  }
  static std::vector<Corners> triangles() {
    return {{0, 1, 2}, {0, 2, 3}, {4, 1, 0}, {5, 2, 1}, {6, 3, 2}, {7, 0, 3}};
  }

  HeightGrid grid_;
  SampleField field_;
  HalfedgeMesh mesh_;
  std::vector<TerrainVertex> vertices_;
  EdgeFlip flip_;
};

TEST(EdgeFlip, IsBetterWhereARidgeRunsAcrossTheEdge) {
  EXPECT_TRUE(Quad(true).is_better());
  EXPECT_FALSE(Quad(false).is_better());
}

TEST(EdgeFlip, LeavesAnEdgeBetweenTwoVerticesOfALine) {
  Quad quad(true);
  quad.vertex(0).kind = VertexKind::kFeature;
  EXPECT_TRUE(quad.is_better());
  quad.vertex(2).kind = VertexKind::kLocked;
  EXPECT_FALSE(quad.is_better());
}

TEST(EdgeFlip, MakesNoEdgeBetweenTwoVerticesOfTheOutline) {
  Quad quad(true);
  quad.vertex(1).kind = quad.vertex(3).kind = VertexKind::kOutline;
  EXPECT_FALSE(quad.is_better());
}

TEST(EdgeFlip, RefusesAQuadThatIsNotConvex) {
  Quad quad(true);
  quad.vertex(0).place = cell(5, 4, 0);  // beyond the line from 1 to 3
  EXPECT_FALSE(quad.is_better());
}

TEST(EdgeFlip, KeepsTheTolerance) {
  Quad quad(true);
  quad.vertex(3).place = cell(6, 2, 5);  // 5 m over its sample
  EXPECT_FALSE(quad.is_better(4));
}

}  // namespace
}  // namespace terrane::hierarchy

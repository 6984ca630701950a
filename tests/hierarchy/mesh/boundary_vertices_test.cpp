#include "hierarchy/mesh/boundary_vertices.h"

#include <gtest/gtest.h>

#include "hierarchy/mesh/halfedge_mesh.h"

namespace terrane::hierarchy {
namespace {

/// What the half-edges of the same triangles say.
std::vector<bool> by_halfedges(std::uint32_t vertex_count, const std::vector<Corners>& triangles) {
  const HalfedgeMesh mesh(vertex_count, triangles);
  std::vector<bool> is_boundary(vertex_count, false);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.is_boundary(VertexId{v})) is_boundary[mesh.origin(VertexId{v})] = true;
  }
  return is_boundary;
}

/// Two triangles for each cell of a square of samples, without those that \p leaves_out names.
template <class LeavesOut>
std::vector<Corners> square(std::uint32_t side, const LeavesOut& leaves_out) {
  std::vector<Corners> triangles;
  for (std::uint32_t row = 0; row + 1 < side; ++row) {
    for (std::uint32_t column = 0; column + 1 < side; ++column) {
      if (leaves_out(column, row)) continue;
      const std::uint32_t a = row * side + column, b = a + 1, c = a + side, d = c + 1;
      triangles.push_back({a, c, b});
      triangles.push_back({b, c, d});
    }
  }
  return triangles;
}

TEST(BoundaryVertices, OfASquareAreItsSides) {
  const auto triangles = square(4, [](auto, auto) { return false; });
  const std::vector<bool> is_boundary = boundary_vertices(16, triangles);
  for (std::size_t v = 0; v < 16; ++v) {
    const std::size_t column = v % 4, row = v / 4;
    EXPECT_EQ(is_boundary[v], column == 0 || column == 3 || row == 0 || row == 3) << v;
  }
}

TEST(BoundaryVertices, AreThoseOfTheHalfedgesAlsoWhereHolesTouch) {
  // holes in a checkerboard: several fans at every corner of theirs
  const auto triangles =
      square(9, [](auto column, auto row) { return column > 1 && row > 2 && (column + row) % 2; });
  EXPECT_EQ(boundary_vertices(81, triangles), by_halfedges(81, triangles));
}

TEST(BoundaryVertices, WithoutTrianglesAreNone) {
  EXPECT_EQ(boundary_vertices(2, {}), std::vector<bool>(2, false));
}

}  // namespace
}  // namespace terrane::hierarchy

#include "hierarchy/mesh/halfedge_mesh.h"

#include <gtest/gtest.h>

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "core/errors.h"
#include "hierarchy/mesh/stencil.h"
#include "tests/hierarchy/test_meshes.h"

namespace terrane::hierarchy {
namespace {

using testing::grid_of;
using testing::triangles_of;
using OracleMesh = OpenMesh::TriMesh_ArrayKernelT<>;

/// OpenMesh refuses a face that would make its half-edge structure non-manifold.
struct Oracle {
  bool is_manifold = true;
  long euler = 0;

  explicit Oracle(const std::vector<Corners>& triangles) {
    OracleMesh mesh;
    std::map<std::uint32_t, OracleMesh::VertexHandle> handles;
    for (const Corners& corners : triangles) {
      std::vector<OracleMesh::VertexHandle> face;
      for (const std::uint32_t v : corners) {
        auto [at, is_new] = handles.try_emplace(v);
        if (is_new) at->second = mesh.add_vertex(OracleMesh::Point(0, 0, 0));
        face.push_back(at->second);
      }
      is_manifold = is_manifold && mesh.add_face(face).is_valid();
    }
    euler = static_cast<long>(mesh.n_vertices()) - static_cast<long>(mesh.n_edges()) +
            static_cast<long>(mesh.n_faces());
  }
};

/// A grid of 7 x 6 samples with a hole of one sample in the middle.
std::vector<Corners> ring() {
  const HeightGrid grid = grid_of(7, 6, [](auto c, auto r) { return c == 3 && r == 3 ? NAN : 0; });
  return triangulate(grid, grid.window).triangles;
}

TEST(HalfedgeMesh, OppositeOfOppositeIsTheHalfedgeItself) {
  const auto triangles = triangles_of(5, 4);
  const HalfedgeMesh mesh(20, triangles);
  for (std::uint32_t i = 0; i < mesh.triangle_count() * 3; ++i) {
    const HalfedgeId h{i};
    ASSERT_NE(mesh.opposite(h), kNoHalfedge);
    EXPECT_EQ(mesh.opposite(mesh.opposite(h)), h);
    EXPECT_EQ(mesh.start(mesh.opposite(h)), mesh.end(h));
  }
}

TEST(HalfedgeMesh, ClosesEachBoundaryLoopWithOnePointAtInfinity) {
  const HalfedgeMesh mesh(41, ring());
  std::set<VertexId> ghosts;
  std::uint32_t ghost_triangles = 0;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    if (!mesh.is_ghost(TriangleId{t})) continue;
    ++ghost_triangles;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const VertexId v = mesh.start(HalfedgeMesh::halfedge(TriangleId{t}, k));
      if (mesh.is_ghost(v)) ghosts.insert(v);
    }
  }
  EXPECT_EQ(ghosts.size(), 2U);
  // 2 (6 + 5) edges outside; inside 4 cells with three samples and 4 sides of the neighbours
  EXPECT_EQ(ghost_triangles, 22U + 4U);
}

TEST(HalfedgeMesh, ValenceOfAnInnerGridVertexIsSix) {
  const HalfedgeMesh mesh(25, triangles_of(5, 5));
  EXPECT_EQ(mesh.valence(VertexId{12}), 6U);
}

TEST(HalfedgeMesh, SplitsAVertexWhereTwoFansMeet) {
  // two triangles that share only vertex 0
  const HalfedgeMesh mesh(5, std::vector<Corners>{{0, 1, 2}, {0, 3, 4}});
  EXPECT_EQ(mesh.vertex_count(), 6U);
  EXPECT_EQ(mesh.origin(VertexId{5}), 0U);
  EXPECT_TRUE(mesh.is_split(VertexId{0}));
  EXPECT_TRUE(mesh.is_split(VertexId{5}));
  EXPECT_FALSE(mesh.is_split(VertexId{1}));
}

TEST(HalfedgeMesh, RefusesAnEdgeWithThreeTriangles) {
  EXPECT_THROW(HalfedgeMesh(5, std::vector<Corners>{{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}),
               TopologyError);
}

TEST(HalfedgeMesh, RefusesNeighboursOfDifferentOrientation) {
  EXPECT_THROW(HalfedgeMesh(4, std::vector<Corners>{{0, 1, 2}, {0, 1, 3}}), TopologyError);
}

TEST(HalfedgeMesh, RefusesATriangleThatRepeatsACorner) {
  EXPECT_THROW(HalfedgeMesh(3, std::vector<Corners>{{0, 1, 1}}), TopologyError);
}

TEST(HalfedgeMesh, TriangleCollapseRemovesFourTrianglesAndTwoVertices) {
  HalfedgeMesh mesh(64, triangles_of(8, 8));
  StencilWalker walker(mesh);
  Stencil stencil;
  const TriangleId inner{2 * (3 * 7 + 3)};
  ASSERT_EQ(walker.around_triangle(inner, stencil), Collapsibility::kYes);
  std::uint32_t valences = 0;
  for (const VertexId v : stencil.core_span()) valences += mesh.valence(v);
  const auto before = mesh.triangles().size();

  mesh.collapse(stencil.spokes, stencil.dying_span(), stencil.core[0]);

  EXPECT_EQ(mesh.triangles().size(), before - 4);
  EXPECT_EQ(mesh.valence(stencil.core[0]), valences - 9);  // P1, section 3.2
  EXPECT_EQ(mesh.outgoing(stencil.core[1]), kNoHalfedge);
  EXPECT_EQ(mesh.outgoing(stencil.core[2]), kNoHalfedge);
}

class RandomCollapses : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomCollapses, KeepTheMeshManifoldAndItsEulerCharacteristic) {
  std::mt19937 random(GetParam());
  HalfedgeMesh mesh(41, ring());
  const Oracle before(mesh.triangles());
  ASSERT_TRUE(before.is_manifold);
  ASSERT_EQ(before.euler, 0);  // an annulus

  StencilWalker walker(mesh);
  Stencil stencil;
  int collapses = 0;
  for (int i = 0; i < 400; ++i) {
    const HalfedgeId h{static_cast<std::uint32_t>(random() % (mesh.triangle_count() * 3))};
    const TriangleId t = HalfedgeMesh::triangle(h);
    if (!mesh.is_live(t) || mesh.is_ghost(t)) continue;
    const Collapsibility verdict =
        random() % 2 == 0 ? walker.around_triangle(t, stencil) : walker.around_edge(h, stencil);
    if (verdict != Collapsibility::kYes) continue;
    mesh.collapse(stencil.spokes, stencil.dying_span(), stencil.core[0]);
    ++collapses;
    const Oracle after(mesh.triangles());
    ASSERT_TRUE(after.is_manifold) << "after collapse " << collapses;
    ASSERT_EQ(after.euler, 0) << "after collapse " << collapses;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      const HalfedgeId first = mesh.outgoing(VertexId{v});
      if (first == kNoHalfedge) continue;
      std::uint32_t edges = 0;
      HalfedgeId around = first;
      do {
        ASSERT_EQ(mesh.start(around), VertexId{v});
        around = mesh.rotate(around);
        ++edges;
      } while (around != first && edges < 1000);
      ASSERT_EQ(mesh.valence(VertexId{v}), edges);
    }
  }
  EXPECT_GT(collapses, 3);
}

using Neighbourhood = std::vector<std::uint32_t>;

/// Vertices about each live one, in the order of the walk, by the names given; ghosts by no name.
std::map<std::uint32_t, Neighbourhood> neighbourhoods(const HalfedgeMesh& mesh,
                                                      const std::vector<VertexId>& names) {
  std::map<std::uint32_t, Neighbourhood> result;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const HalfedgeId first = mesh.outgoing(VertexId{v});
    if (first == kNoHalfedge) continue;
    Neighbourhood& around = result[static_cast<std::uint32_t>(names[v])];
    HalfedgeId h = first;
    do {
      const VertexId end = mesh.end(h);
      around.push_back(mesh.is_ghost(end) ? 0 : 1 + static_cast<std::uint32_t>(names[index(end)]));
      h = mesh.rotate(h);
    } while (h != first);
    EXPECT_EQ(mesh.valence(VertexId{v}), around.size());
  }
  return result;
}

TEST_P(RandomCollapses, ThenCompactingKeepsEveryNeighbourhoodAndItsOrder) {
  std::mt19937 random(GetParam());
  HalfedgeMesh mesh(41, ring());
  StencilWalker walker(mesh);
  Stencil stencil;
  const auto collapse_some = [&](int tries) {
    for (int i = 0; i < tries; ++i) {
      const TriangleId t{static_cast<std::uint32_t>(random() % mesh.triangle_count())};
      if (!mesh.is_live(t) || mesh.is_ghost(t)) continue;
      if (walker.around_triangle(t, stencil) != Collapsibility::kYes) continue;
      mesh.collapse(stencil.spokes, stencil.dying_span(), stencil.core[0]);
    }
  };
  collapse_some(60);
  std::vector<VertexId> same;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) same.push_back(VertexId{v});
  const auto before = neighbourhoods(mesh, same);
  const std::uint32_t live = mesh.live_triangle_count();

  const Survivors survivors = mesh.compact();

  EXPECT_EQ(mesh.vertex_count(), before.size());
  EXPECT_EQ(mesh.live_triangle_count(), live);
  EXPECT_EQ(mesh.triangle_count(), survivors.triangles.size());
  EXPECT_TRUE(std::ranges::is_sorted(survivors.triangles));
  EXPECT_EQ(neighbourhoods(mesh, survivors.vertices), before);
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
    EXPECT_TRUE(mesh.is_live(TriangleId{t}));

  collapse_some(60);
  EXPECT_TRUE(Oracle(mesh.triangles()).is_manifold);
  EXPECT_EQ(Oracle(mesh.triangles()).euler, 0);
}

TEST(HalfedgeMesh, FlipReplacesADiagonalAndFlippingBackRestoresIt) {
  // the square 0 1 2 3 in the middle of a larger one, so that every corner may lose an edge
  const std::vector<Corners> square{{0, 1, 2}, {0, 2, 3}, {4, 1, 0},
                                    {5, 2, 1}, {6, 3, 2}, {7, 0, 3}};
  HalfedgeMesh mesh(8, square);
  const HalfedgeId diagonal = HalfedgeMesh::halfedge(TriangleId{0}, 2);  // from 2 to 0
  mesh.flip(diagonal);
  const Oracle flipped(mesh.triangles());
  EXPECT_TRUE(flipped.is_manifold);
  EXPECT_EQ(flipped.euler, 1);
  EXPECT_EQ(std::minmax(mesh.start(diagonal), mesh.end(diagonal)),
            std::minmax(VertexId{1}, VertexId{3}));
  for (std::uint32_t v = 0; v < 8; ++v) {
    EXPECT_EQ(mesh.start(mesh.outgoing(VertexId{v})), VertexId{v});
  }
  const std::uint32_t edges_of_2 = mesh.valence(VertexId{2});
  mesh.flip(diagonal);
  EXPECT_EQ(mesh.valence(VertexId{2}), edges_of_2 + 1);
  EXPECT_EQ(std::minmax(mesh.start(diagonal), mesh.end(diagonal)),
            std::minmax(VertexId{0}, VertexId{2}));
  EXPECT_TRUE(Oracle(mesh.triangles()).is_manifold);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomCollapses, ::testing::Range(0U, 200U));

}  // namespace
}  // namespace terrane::hierarchy

#include "hierarchy/levels/ancestral_points.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "hierarchy/mesh/stencil.h"
#include "tests/hierarchy/levels/test_surfaces.h"

namespace terrane::hierarchy {
namespace {

using Points = std::set<std::uint32_t>;

Points corners_of(const HalfedgeMesh& mesh, TriangleId t) {
  Points result;
  for (std::uint32_t k = 0; k < 3; ++k) {
    result.insert(static_cast<std::uint32_t>(mesh.start(HalfedgeMesh::halfedge(t, k))));
  }
  return result;
}

TEST(AncestralPoints, OfTheCornersAreThePapersSetsOfTheTriangle) {
  const SurfaceMesh torus = testing::torus(12, 9);
  HalfedgeMesh mesh(108, torus.triangles);
  std::vector<Eigen::Vector3i> points;
  for (int v = 0; v < 108; ++v) points.emplace_back(v, 0, 0);
  AncestralPoints ancestors(points);
  // figure 21, word for word: T gets the points of T' and of the collapsed triangle
  std::vector<Points> papers;
  const auto expect_papers_sets = [&](const std::vector<TriangleId>& triangles) {
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      if (!mesh.is_live(TriangleId{t})) continue;
      Points ours;
      std::size_t count = 0;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const VertexId v = mesh.start(HalfedgeMesh::halfedge(TriangleId{t}, k));
        ancestors.for_each(v, [&](const Eigen::Vector3i& p) {
          ours.insert(static_cast<std::uint32_t>(p.x()));
          ++count;
        });
      }
      EXPECT_EQ(ours, papers[index(triangles[t])]);
      EXPECT_EQ(count, ours.size()) << "the sets of the corners are disjoint";
    }
  };
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    papers.push_back(corners_of(mesh, TriangleId{t}));
  }
  std::mt19937 random(3);
  StencilWalker walker(mesh);
  Stencil stencil;
  int collapses = 0;
  for (int i = 0; i < 2000; ++i) {
    const TriangleId t{static_cast<std::uint32_t>(random() % mesh.triangle_count())};
    if (!mesh.is_live(t) || walker.around_triangle(t, stencil) != Collapsibility::kYes) continue;
    for (const HalfedgeId h : stencil.spokes) {
      papers[index(HalfedgeMesh::triangle(h))].insert(papers[index(t)].begin(),
                                                      papers[index(t)].end());
    }
    ancestors.join(stencil.core[0], stencil.core[1]);
    ancestors.join(stencil.core[0], stencil.core[2]);
    mesh.collapse(stencil.spokes, stencil.dying_span(), stencil.core[0]);
    ++collapses;
  }
  ASSERT_GT(collapses, 10);
  std::vector<TriangleId> same;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) same.push_back(TriangleId{t});
  expect_papers_sets(same);

  const Survivors survivors = mesh.compact();
  ancestors.compact(survivors.vertices);
  ASSERT_LT(survivors.triangles.size(), same.size());
  expect_papers_sets(survivors.triangles);
}

}  // namespace
}  // namespace terrane::hierarchy

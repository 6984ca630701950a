#include "hierarchy/levels/swap_cycles.h"

#include <gtest/gtest.h>

#include <set>

#include "hierarchy/levels/build_levels.h"
#include "tests/hierarchy/levels/test_surfaces.h"

namespace terrane::hierarchy {
namespace {

/// A sheet with a vertex put into the middle of every n-th triangle.
SurfaceMesh with_cycles(std::size_t every) {
  SurfaceMesh mesh = testing::saddle(13, 13);
  const std::size_t count = mesh.triangles.size();
  for (std::size_t t = every / 2; t < count; t += every) {
    const auto [a, b, c] = mesh.triangles[t];
    const auto v = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.push_back((mesh.points[a] + mesh.points[b] + mesh.points[c]) / 3);
    mesh.triangles[t] = {a, b, v};
    mesh.triangles.push_back({b, c, v});
    mesh.triangles.push_back({c, a, v});
  }
  return mesh;
}

TEST(SwapCycles, LeavesNoVertexOfValenceThreeInside) {
  SurfaceMesh mesh = with_cycles(17);
  const testing::Oracle before(mesh.triangles);
  const auto count = mesh.triangles.size();
  const CycleSwaps swaps = swap_cycles(mesh);
  EXPECT_EQ(swaps.found, 17U);  // triangles 8, 25, ... of 288
  EXPECT_EQ(swaps.removed, swaps.found);
  const testing::Oracle after(mesh.triangles);
  EXPECT_TRUE(after.is_manifold);
  EXPECT_EQ(after.euler, before.euler);
  EXPECT_EQ(mesh.triangles.size(), count);
  EXPECT_TRUE(is_height_field(mesh)) << "no triangle was turned over";
  EXPECT_EQ(swap_cycles(mesh).found, 0U);
}

/// Vertices inside with three triangles, in M_i.
std::ptrdiff_t cycles_at(const LevelSequence& sequence, std::uint32_t level) {
  const SurfaceMesh mesh = testing::mesh_at(sequence, level);
  std::vector<std::set<std::uint32_t>> neighbours(mesh.points.size());
  std::vector<std::size_t> triangles(mesh.points.size());
  for (const auto& corners : mesh.triangles) {
    for (const std::uint32_t v : corners) {
      ++triangles[v];
      for (const std::uint32_t other : corners) {
        if (other != v) neighbours[v].insert(other);
      }
    }
  }
  std::ptrdiff_t count = 0;
  for (std::size_t v = 0; v < triangles.size(); ++v) {
    count += triangles[v] == 3 && neighbours[v].size() == 3;
  }
  return count;
}

TEST(SwapCycles, NoLevelOfASwappedMeshHasACycle) {
  SurfaceMesh mesh = with_cycles(17);
  const LevelSequence as_it_is = build_levels(mesh, {.most_levels = 12});
  swap_cycles(mesh);
  const LevelSequence swapped = build_levels(mesh, {.most_levels = 12});
  EXPECT_EQ(cycles_at(as_it_is, 0), 17);
  for (std::uint32_t level = 0; level <= swapped.level_count(); ++level) {
    EXPECT_EQ(cycles_at(swapped, level), 0) << level;
  }
}

TEST(SwapCycles, LeavesAMeshWithoutCyclesAsItIs) {
  SurfaceMesh mesh = testing::saddle(9, 9);
  const auto before = mesh.triangles;
  EXPECT_EQ(swap_cycles(mesh).found, 0U);
  EXPECT_EQ(mesh.triangles, before);
}

TEST(SwapCycles, LeavesATetrahedronAlone) {
  SurfaceMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                   {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
  const CycleSwaps swaps = swap_cycles(mesh);
  EXPECT_EQ(swaps.found, 4U);
  EXPECT_EQ(swaps.removed, 0U);
}

}  // namespace
}  // namespace terrane::hierarchy

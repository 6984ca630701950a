#include "hierarchy/collapse/near_locked.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/hierarchy/test_meshes.h"

namespace terrane::hierarchy {
namespace {

/// A grid of 9 x 9 whose first column is locked.
struct LockedSide {
  TerrainMesh terrain = testing::terrain_of(testing::grid_of(9, 9, [](auto, auto) { return 0; }));
  HalfedgeMesh mesh{static_cast<std::uint32_t>(terrain.vertices.size()), terrain.triangles};

  LockedSide() {
    for (TerrainVertex& vertex : terrain.vertices) {
      if (vertex.place.plan.x == 0) vertex.kind = VertexKind::kLocked;
    }
  }
};

TEST(NearLocked, GoesAColumnFartherWithEachEdge) {
  const LockedSide side;
  for (const int edges : {0, 1, 2, 5}) {
    const auto is_near = near_locked(side.mesh, side.terrain.vertices, edges);
    for (std::size_t v = 0; v < is_near.size(); ++v) {
      EXPECT_EQ(is_near[v] != 0, side.terrain.vertices[v].place.plan.x <= edges * kUnitsPerCell);
    }
  }
}

TEST(NearLocked, IsNothingWhereNothingIsLocked) {
  LockedSide side;
  for (TerrainVertex& vertex : side.terrain.vertices) vertex.kind = VertexKind::kInterior;
  const auto is_near = near_locked(side.mesh, side.terrain.vertices, 2);
  EXPECT_TRUE(std::ranges::all_of(is_near, [](std::uint8_t v) { return v == 0; }));
}

}  // namespace
}  // namespace terrane::hierarchy

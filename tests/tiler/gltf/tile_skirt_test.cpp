#include "tiler/gltf/tile_skirt.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace terrane::tiler {
namespace {

/// The left one of two tiles of 4 x 4 cells as two triangles; samples 4 steps wide, rows downward.
//
//   0 ------- 3     its right side (3 - 2) is shared
//   |  \      |
//   1 ------- 2
TileMesh left_tile() {
  TileMesh mesh;
  mesh.points = {{0, 0, 50}, {0, -16, 50}, {16, -16, 70}, {16, 0, 60}};
  mesh.borders = {{0, 0}, {0, 4}, {4, 4}, {4, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

TEST(HangSkirt, HangsFromSharedBordersAlone) {
  const TileMesh mesh = left_tile();
  const TileSkirt skirt = hang_skirt(Pyramid({9, 5}, 4), {0, 0, 0}, mesh, mesh.points, {0, 0, -30});
  EXPECT_EQ(skirt.triangles.size(), 2U);
  ASSERT_EQ(skirt.points.size(), 4U);
  for (std::size_t v = 0; v < 4; v += 2) {
    EXPECT_EQ(skirt.points[v], mesh.points[skirt.above[v]]);
    EXPECT_EQ(skirt.points[v].i, 16);
    EXPECT_EQ(skirt.points[v + 1].k, skirt.points[v].k - 30);
  }
}

TEST(HangSkirt, IsSeenFromTheNeighboursSide) {
  const TileMesh mesh = left_tile();
  const TileSkirt skirt = hang_skirt(Pyramid({9, 5}, 4), {0, 0, 0}, mesh, mesh.points, {0, 0, -30});
  for (const auto& [a, b, c] : skirt.triangles) {
    const auto at = [&](std::uint32_t v) {
      const LatticePoint& p = skirt.points[v];
      return Eigen::Vector3d(static_cast<double>(p.i), static_cast<double>(p.j),
                             static_cast<double>(p.k));
    };
    EXPECT_GT((at(b) - at(a)).cross(at(c) - at(a)).x(), 0) << "the neighbour is to the east";
  }
}

TEST(HangSkirt, IsWaterWhereItHangsFromWater) {
  TileMesh mesh = left_tile();
  mesh.in_water = {1, 0};  // the second triangle is at the shared side
  const auto hung = [&] {
    return hang_skirt(Pyramid({9, 5}, 4), {0, 0, 0}, mesh, mesh.points, {0, 0, -30}).in_water;
  };
  EXPECT_EQ(hung(), (std::vector<std::uint8_t>{0, 0}));
  mesh.in_water = {0, 1};
  EXPECT_EQ(hung(), (std::vector<std::uint8_t>{1, 1}));
}

TEST(HangSkirt, ATileWithoutNeighboursHasNone) {
  const TileMesh mesh = left_tile();
  EXPECT_TRUE(
      hang_skirt(Pyramid({5, 5}, 4), {0, 0, 0}, mesh, mesh.points, {0, 0, -30}).triangles.empty());
}

}  // namespace
}  // namespace terrane::tiler

#include "hierarchy/collapse/triangle_shape.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/hierarchy/test_meshes.h"

namespace terrane::hierarchy {
namespace {

using testing::BentPlacer;
using testing::ExactPlacer;

Place cell(double column, double row, double height_m = 0) {
  return ExactPlacer().place({static_cast<std::int32_t>(column * kUnitsPerCell),
                              static_cast<std::int32_t>(-row * kUnitsPerCell)},
                             height_m);
}

TEST(TriangleShape, FoldedTriangleIsNotUpright) {
  EXPECT_TRUE(is_upright(cell(0, 4), cell(4, 4), cell(0, 0), 0, ExactPlacer()));
  EXPECT_FALSE(is_upright(cell(0, 4), cell(0, 0), cell(4, 4), 0, ExactPlacer()));
  EXPECT_FALSE(is_upright(cell(0, 4), cell(4, 4), cell(2, 4), 0, ExactPlacer()));
}

TEST(TriangleShape, AltitudeOnTheLongestSideIsTheSmallest) {
  // 3, 4, 5: the altitude on the longest side is 3 * 4 / 5
  const double altitude2 = squared_altitude(cell(0, 0).plan, cell(0, 3).plan, cell(4, 0).plan);
  EXPECT_DOUBLE_EQ(std::sqrt(altitude2) / kUnitsPerCell, 2.4);
  EXPECT_TRUE(is_upright(cell(0, 0), cell(0, 3), cell(4, 0), 2.39, ExactPlacer()));
  EXPECT_FALSE(is_upright(cell(0, 0), cell(0, 3), cell(4, 0), 2.41, ExactPlacer()));
}

TEST(TriangleShape, LongSliverMustBeUprightInTheWorld) {
  // the world's straight line between columns 0 and 20 of row 0 passes 1 cell below column 10
  const BentPlacer bent(0.01);
  const auto sliver = [](double altitude) {
    return std::array{cell(20, 0), cell(0, 0), cell(10, altitude)};
  };
  const auto is_upright_in = [](const std::array<Place, 3>& t, const Placer& placer) {
    return is_upright(t[0], t[1], t[2], 0.1, placer);
  };
  EXPECT_TRUE(is_upright_in(sliver(0.5), ExactPlacer()));
  EXPECT_FALSE(is_upright_in(sliver(0.5), bent));
  EXPECT_FALSE(is_upright_in(sliver(1.05), bent));
  EXPECT_TRUE(is_upright_in(sliver(1.15), bent));
}

TEST(TriangleShape, SteepTriangleIsNotWellShaped) {
  const Place a = cell(0, 0), b = cell(0, 4), c = cell(4, 0, 12);  // 3 m per cell
  EXPECT_TRUE(is_well_shaped(a, b, c, {.steepest_m = 3.01}, ExactPlacer()));
  EXPECT_FALSE(is_well_shaped(a, b, c, {.steepest_m = 2.99}, ExactPlacer()));
}

}  // namespace
}  // namespace terrane::hierarchy

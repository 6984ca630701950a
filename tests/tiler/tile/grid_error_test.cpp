#include "tiler/tile/grid_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tiler/test_dem.h"

namespace terrane::tiler {
namespace {

using hierarchy::kUnitsPerCell;
using hierarchy::TerrainMesh;
using hierarchy::TerrainVertex;

TerrainVertex vertex(double column, double row, double height_m) {
  return {.place = {{static_cast<std::int32_t>(column * kUnitsPerCell),
                     static_cast<std::int32_t>(-row * kUnitsPerCell)},
                    height_m,
                    {}}};
}

/// Two flat triangles over the square from (0, 0) to (side, side), the diagonal from the first
/// sample to the last.
TerrainMesh square(double side, double height_m) {
  return {{vertex(0, 0, height_m), vertex(0, side, height_m), vertex(side, side, height_m),
           vertex(side, 0, height_m)},
          {{0, 1, 2}, {0, 2, 3}}};
}

HeightGrid flat_grid(std::int64_t side, float height_m) {
  return {{0, 0, side, side}, std::vector<float>(static_cast<std::size_t>(side * side), height_m)};
}

TEST(MeasureOverGrid, FindsTheWorstSampleAndTheMeanSquare) {
  HeightGrid grid = flat_grid(5, 10);
  grid.heights_m[7] = 13;
  grid.heights_m[20] = 6;
  const GridError error = measure_over_grid(square(4, 10), grid);
  EXPECT_EQ(error.max_m, 4);
  EXPECT_DOUBLE_EQ(error.rms_m, std::sqrt((9.0 + 16.0) / 25));
  EXPECT_EQ(error.samples, 25);
  EXPECT_EQ(error.uncovered, 0);
  EXPECT_EQ(error.folded, 0);
}

TEST(MeasureOverGrid, InterpolatesLinearly) {
  const TerrainMesh slope{{vertex(0, 0, 0), vertex(0, 4, 8), vertex(4, 4, 20), vertex(4, 0, 12)},
                          {{0, 1, 2}, {0, 2, 3}}};
  HeightGrid grid = flat_grid(5, 0);
  for (int i = 0; i < 25; ++i) grid.heights_m[i] = static_cast<float>(3 * (i % 5) + 2 * (i / 5));
  EXPECT_LT(measure_over_grid(slope, grid).max_m, 1e-12);
}

TEST(MeasureOverGrid, CountsSamplesOutsideEveryTriangle) {
  const GridError error = measure_over_grid(square(3, 0), flat_grid(5, 0));
  EXPECT_EQ(error.samples, 16);
  EXPECT_EQ(error.uncovered, 9);
}

TEST(MeasureOverGrid, NoDataIsNoSample) {
  HeightGrid grid = flat_grid(5, 0);
  grid.heights_m[24] = kNoHeight;
  grid.heights_m[12] = kNoHeight;
  const GridError error = measure_over_grid(square(3, 0), grid);
  EXPECT_EQ(error.samples, 15);
  EXPECT_EQ(error.uncovered, 8);
}

TEST(MeasureOverGrid, AnEdgeOneGridUnitShortOfASampleDoesNotCoverIt) {
  const double unit = 1.0 / kUnitsPerCell;
  EXPECT_EQ(measure_over_grid(square(4 - unit, 0), flat_grid(5, 0)).samples, 16);
  EXPECT_EQ(measure_over_grid(square(4, 0), flat_grid(5, 0)).samples, 25);
}

TEST(MeasureOverGrid, ASampleOnAStepIsMeasuredOnBothSides) {
  // a vertical step at column 2: its samples are at the foot of one side and at the top of the
  // other
  TerrainMesh mesh{{vertex(0, 0, 0), vertex(0, 4, 0), vertex(2, 4, 0), vertex(2, 0, 0),
                    vertex(2, 0, 7), vertex(2, 4, 7), vertex(4, 4, 7), vertex(4, 0, 7)},
                   {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}};
  EXPECT_EQ(measure_over_grid(mesh, flat_grid(5, 0)).max_m, 7);
  for (std::size_t v = 4; v < 8; ++v) mesh.vertices[v].place.height_m = -7;
  EXPECT_EQ(measure_over_grid(mesh, flat_grid(5, 0)).max_m, 7);
}

TEST(MeasureOverGrid, CountsTrianglesThatAreTurnedOverOrHaveNoArea) {
  TerrainMesh mesh = square(4, 0);
  mesh.triangles.push_back({0, 2, 1});
  mesh.triangles.push_back({0, 0, 2});
  EXPECT_EQ(measure_over_grid(mesh, flat_grid(5, 0)).folded, 2);
}

TEST(MeasureOverGrid, AWindowIsPartOfTheDem) {
  HeightGrid grid{{2, 3, 2, 1}, {10, 13}};
  const GridError error = measure_over_grid(square(4, 10), grid);
  EXPECT_EQ(error.samples, 2);
  EXPECT_EQ(error.max_m, 3);
}

TEST(MeasureOverDem, StripsCountEverySampleOnce) {
  const testing::FunctionDem dem({5, 5},
                                 [](auto c, auto r) { return c == 1 && r == 2 ? 13.0 : 10.0; });
  for (const std::int64_t samples_at_once : {1, 5, 10, 100}) {
    const GridError error = measure_over_dem(square(4, 10), dem, samples_at_once);
    EXPECT_EQ(error.samples, 25);
    EXPECT_EQ(error.uncovered, 0);
    EXPECT_EQ(error.max_m, 3);
    EXPECT_DOUBLE_EQ(error.rms_m, std::sqrt(9.0 / 25));
  }
}

}  // namespace
}  // namespace terrane::tiler

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/tiler/verify/fake_output.h"

namespace terrane::verify::testing {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr GridShape kShape{17, 17};
constexpr double kCell_m = 8;

bool is_wet(std::int64_t column, std::int64_t row) {
  return column >= 4 && column <= 12 && row >= 4 && row <= 12;
}

/// A lake at 20 m in a slope; its shore runs along columns and rows 4 and 12.
struct LakeOutput : ::testing::Test {
  FakeDem dem{kShape, [](auto column, auto row) {
                return is_wet(column, row) ? 20.0F : static_cast<float>(4 * column + 8 * row);
              }};
  FlatPlace place;
  FakeOutput output = repeated_grids(dem, flat_world(place), 4, 1);
  std::vector<WaterArea> water{area()};

  LakeOutput() {
    for (FakeTile& tile : output.tiles) {
      for (std::size_t n = 0; n < tile.triangles.size(); ++n) {
        const bool wet = std::ranges::all_of(tile.triangles[n], [&](std::uint32_t v) {
          return is_wet(tile.sample[v][0], tile.sample[v][1]);
        });
        if (wet) tile.in_water.insert(n);
      }
    }
  }

  static WaterArea area() {
    const FlatPlace place;
    WaterArea area{{{}}, 20.0F};
    for (const GridPosition corner :
         {GridPosition{4, 4}, GridPosition{12, 4}, GridPosition{12, 12}, GridPosition{4, 12}}) {
      area.shores[0].push_back(place.to_plan(corner));
    }
    return area;
  }

  VerifyReport verdict() const { return verdict_on(output, dem, place, water); }
};

TEST_F(LakeOutput, HoldsWhereWaterIsInItsShore) {
  const VerifyReport report = verdict();
  EXPECT_TRUE(report.holds()) << to_text(report);
  for (const LevelReport& level : report.levels) EXPECT_EQ(level.water_triangles, 2 * 8 * 8);
  EXPECT_THAT(to_text(report), HasSubstr("wrong_side"));
}

TEST_F(LakeOutput, ALandTriangleMarkedAsWaterIsFound) {
  FakeTile& tile = output.tile(0, 3, 0);
  tile.in_water.insert(tile.triangle_at({{{13, 1}, {13, 2}, {14, 2}}}));
  const VerifyReport report = verdict();
  EXPECT_FALSE(report.holds());
  EXPECT_EQ(report.levels[0].uneven_water_triangles, 1);
  EXPECT_EQ(report.levels[1].uneven_water_triangles, 0);
  EXPECT_THAT(report.problems,
              Contains(AllOf(HasSubstr("tile 0/3/0"), HasSubstr("height of a lake"))));
}

TEST_F(LakeOutput, LevelLandMarkedAsWaterIsFoundByItsSamples) {
  // as flat and as high as the lake, but beyond its shore
  const FakeDem plain(kShape, [](auto, auto) { return 20.0F; });
  output = repeated_grids(plain, flat_world(place), 4, 1);
  water[0].height_m.reset();
  for (FakeTile& tile : output.tiles) {
    for (std::size_t n = 0; n < tile.triangles.size(); ++n) tile.in_water.insert(n);
  }
  const VerifyReport report = verdict_on(output, plain, place, water);
  EXPECT_FALSE(report.holds());
  // each of 289 samples but the 81 in the lake and on its shore; on borders of leaves once for each
  std::int64_t expected = 0;
  for (std::int64_t y = 0; y < 4; ++y) {
    for (std::int64_t x = 0; x < 4; ++x) {
      for (std::int64_t row = 4 * y; row <= 4 * y + 4; ++row) {
        for (std::int64_t column = 4 * x; column <= 4 * x + 4; ++column) {
          expected += !is_wet(column, row);
        }
      }
    }
  }
  for (const LevelReport& level : report.levels) {
    EXPECT_EQ(level.samples_on_wrong_side, expected);
  }
}

TEST_F(LakeOutput, WaterMarkedAsLandIsFound) {
  FakeTile& tile = output.tile(0, 1, 1);
  for (const std::size_t n :
       {tile.triangle_at({{{5, 5}, {5, 6}, {6, 6}}}), tile.triangle_at({{{5, 5}, {6, 6}, {6, 5}}}),
        tile.triangle_at({{{5, 6}, {6, 7}, {6, 6}}}), tile.triangle_at({{{6, 5}, {6, 6}, {7, 6}}}),
        tile.triangle_at({{{6, 6}, {6, 7}, {7, 7}}}),
        tile.triangle_at({{{6, 6}, {7, 7}, {7, 6}}})}) {
    tile.in_water.erase(n);
  }
  const VerifyReport report = verdict();
  EXPECT_EQ(report.levels[0].samples_on_wrong_side, 1) << "sample (6, 6), all around it is land";
  EXPECT_THAT(report.problems,
              Contains(AllOf(HasSubstr("tile 0/1/1"), HasSubstr("column 6, row 6"))));
}

TEST_F(LakeOutput, WaterAtAnotherHeightIsFound) {
  water[0].height_m = 20.5F;  // two steps of the lattice
  const VerifyReport report = verdict();
  for (const LevelReport& level : report.levels) {
    EXPECT_EQ(level.uneven_water_triangles, level.water_triangles);
  }
}

TEST_F(LakeOutput, WaterThatNoPolygonKnowsIsFound) {
  water.clear();
  const VerifyReport report = verdict();
  EXPECT_FALSE(report.holds());
  // the lake is four leaves, each of 5 x 5 samples
  EXPECT_EQ(report.levels[0].samples_on_wrong_side, 4 * 25);
}

TEST_F(LakeOutput, AShoreMayLieOffItsPlaceByTheTolerance) {
  for (double off_m : {0.9 * kCell_m, 1.1 * kCell_m}) {
    const double tolerance_m = kCell_m;
    for (FakeLevel& level : output.levels) level.tolerance_m = tolerance_m;
    water = {area()};
    for (PlanPosition& p : water[0].shores[0]) p.x += off_m;
    const VerifyReport report = verdict();
    EXPECT_EQ(report.levels[0].samples_on_wrong_side > 0, off_m > tolerance_m) << off_m;
  }
}

}  // namespace
}  // namespace terrane::verify::testing

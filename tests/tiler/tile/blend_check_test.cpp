#include "tiler/tile/blend_check.h"

#include <gtest/gtest.h>

#include "tests/tiler/test_dem.h"
#include "tiler/tile/lattice.h"
#include "tiler/tile/world_frame.h"

namespace terrane::tiler {
namespace {

using hierarchy::Corners;
using hierarchy::kUnitsPerCell;
using hierarchy::Place;
using testing::FunctionDem;
using testing::PlainPlace;

double slope_m(std::int64_t column, std::int64_t row) {
  return static_cast<double>(column) + 2 * static_cast<double>(row);
}

/// A slope with one spike of 50 m, over more samples than a patch holds.
double slope_with_spike_m(std::int64_t column, std::int64_t row) {
  return slope_m(column, row) + (column == 1000 && row == 1777 ? 50 : 0);
}

Place on_slope(std::int32_t column, std::int32_t row) {
  return {.plan = {column * kUnitsPerCell, -row * kUnitsPerCell}, .height_m = slope_m(column, row)};
}

/// A triangle 10 columns wide that slides along the slope, and over the spike at t = 0.55 to 0.6
/// alone.
class SlidingTriangle : public ::testing::Test {
 protected:
  std::vector<hierarchy::FieldSample> left(double tolerance_m) const {
    return samples_left_by({from_, to_, triangles_}, samples_, frame_, 1e-7, tolerance_m);
  }

  FunctionDem dem_{{2200, 2200}, slope_with_spike_m};
  PlainPlace place_{1, 1};
  WorldFrame world_{place_, dem_.shape()};
  Lattice lattice_{std::vector<Eigen::Vector3d>{{0.01, 0.01, 0.01}}};
  Window window_{0, 0, 2200, 2200};
  TileFrame frame_{world_, lattice_, window_, 0};
  TileSamples samples_{dem_, window_, 0, 100};
  std::vector<Place> from_{on_slope(880, 1800), on_slope(890, 1800), on_slope(885, 1700)};
  std::vector<Place> to_{on_slope(1080, 1800), on_slope(1090, 1800), on_slope(1085, 1700)};
  std::vector<Corners> triangles_{{0, 1, 2}};
};

TEST_F(SlidingTriangle, LeavesTheSpikeBetweenAnyMomentsThatOneWouldTry) {
  ASSERT_GT(samples_.patch_count(), 1U);
  const auto left_samples = left(40);
  ASSERT_EQ(left_samples.size(), 1U);
  EXPECT_EQ(left_samples[0].column, 1000);
  EXPECT_EQ(left_samples[0].row, 1777);
  EXPECT_NEAR(left_samples[0].height_m, slope_m(1000, 1777) + 50, 0.01);
}

TEST_F(SlidingTriangle, LeavesNothingWhereTheToleranceIsAsHighAsTheSpike) {
  EXPECT_TRUE(left(51).empty());
}

}  // namespace
}  // namespace terrane::tiler

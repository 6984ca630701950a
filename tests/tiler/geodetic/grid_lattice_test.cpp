#include "tiler/geodetic/grid_lattice.h"

#include <gtest/gtest.h>

#include "core/errors.h"
#include "tests/tiler/geodetic/test_heights.h"
#include "tiler/geodetic/tile_band.h"

namespace terrane::tiler {
namespace {

constexpr GeodeticTiles kBand{.zoom = 5, .x = 12, .y = 8, .columns = 4, .rows = 4};

class GridLatticeTest : public ::testing::Test {
 protected:
  testing::FunctionHeights heights_{kBand, 0, 3000, [](const LonLat&) { return 0; }};
  TileBand band_{heights_, kBand};
  WorldFrame world_{band_, band_.shape()};
  GridLattice lattice_{kBand, world_, 0, 3000, {10, 20, 40}};
};

TEST_F(GridLatticeTest, BordersOfTilesAreMultiplesOfATilesSteps) {
  for (int level = 0; level < 3; ++level) {
    const double side = static_cast<double>(kGeodeticTileCells << level);
    const LatticePoint corner = lattice_.nearest_over_grid({{side, side}, 0}, level);
    EXPECT_EQ(corner.i, kTileSteps) << level;
    EXPECT_EQ(corner.j, -kTileSteps) << level;
  }
}

TEST_F(GridLatticeTest, PointsOfALevelAreOnTheFinerOne) {
  const LatticePoint point{12345, -4321, 77};
  const auto coarse = *lattice_.over_grid(point, 1);
  const auto fine = *lattice_.over_grid(lattice_.refine(point, 0), 0);
  EXPECT_EQ(coarse.at.column, fine.at.column);
  EXPECT_EQ(coarse.at.row, fine.at.row);
  EXPECT_EQ(coarse.height_m, fine.height_m);
}

TEST_F(GridLatticeTest, HeightStepsArePowersOfTwoAndASixteenthOfTheToleranceAtMost) {
  for (int level = 0; level < 3; ++level) {
    const double step_m = lattice_.step_m(level).z();
    EXPECT_EQ(std::exp2(std::round(std::log2(step_m))), step_m);
    EXPECT_LE(step_m, 10.0 * (1 << level) / 16);
  }
}

TEST_F(GridLatticeTest, StandsInTheWorldWhereLongitudeLatitudeAndHeightAre) {
  // the band's middle is the origin of its world: column and row 128, at its own zenith
  const LatticePoint middle = lattice_.nearest_over_grid({{128, 128}, 1000}, 0);
  const Eigen::Vector3d at = lattice_.world(middle, 0);
  EXPECT_NEAR(at.x(), 0, 1e-6);
  EXPECT_NEAR(at.y(), 0, 1e-6);
  EXPECT_NEAR(at.z(), 1000, lattice_.step_m(0).z());
}

TEST_F(GridLatticeTest, RefusesAToleranceThatItsStepsOfHeightCannotHold) {
  EXPECT_THROW(GridLattice(kBand, world_, -11000, 9000, {0.1}), ConfigError);
}

}  // namespace
}  // namespace terrane::tiler

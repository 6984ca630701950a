#include "tiler/tile/lattice.h"

#include <gtest/gtest.h>

#include "tests/tiler/test_dem.h"

namespace terrane::tiler {
namespace {

using testing::PlainPlace;

const Lattice kLattice({{0.5, 0.5, 0.25}, {1, 1, 0.25}, {4, 4, 1}});

TEST(Lattice, NearestRoundsToTheNearestAndHalvesUp) {
  EXPECT_EQ(kLattice.nearest({1.2, -1.2, 0.1}, 0), (LatticePoint{2, -2, 0}));
  EXPECT_EQ(kLattice.nearest({0.25, -0.25, 0.125}, 0), (LatticePoint{1, 0, 1}));
}

TEST(Lattice, CoarsenIsNearestOnTheNextLevelAlsoBelowZero) {
  for (std::int64_t i = -9; i <= 9; ++i) {
    const LatticePoint point{i, -i, i};
    EXPECT_EQ(kLattice.coarsen(point, 0), kLattice.nearest(kLattice.world(point, 0), 1)) << i;
    EXPECT_EQ(kLattice.coarsen(point, 1), kLattice.nearest(kLattice.world(point, 1), 2)) << i;
  }
}

TEST(Lattice, RefineKeepsThePlace) {
  const LatticePoint point{-3, 7, 5};
  EXPECT_EQ(kLattice.world(kLattice.refine(point, 1), 1), kLattice.world(point, 2));
}

TEST(Lattice, TheSteepestTriangleStaysWithinTheToleranceWhereALevelIsRoundedAnew) {
  const double rise = steepest(kLattice, {1, 2, 4});
  const double level_1_m = rise * std::sqrt(0.5) * 1, level_2_m = rise * std::sqrt(0.5) * 4;
  EXPECT_LE(1 + level_1_m, 2);
  EXPECT_LE(2 + level_2_m, 4);
  EXPECT_GT(2 + level_2_m, 3.5);  // and uses what there is
}

TEST(Lattice, AnyTriangleMayBeSteepWhereNoLevelIsRoundedAnew) {
  EXPECT_EQ(steepest(Lattice({{1, 1, 1}, {1, 1, 2}}), {1, 2}), INFINITY);
}

/// A DEM of 1000 x 700 samples, 30 m apart, 4,400 m of relief.
class ChosenSteps : public ::testing::Test {
 protected:
  Lattice lattice(double tolerance_m) const {
    return Lattice(pyramid_, world_, {1, -100, 4300, ""}, tolerance_m);
  }

  const PlainPlace place_{30, 30};
  const Pyramid pyramid_{{1000, 700}, 64};
  const WorldFrame world_{place_, {1000, 700}};
};

TEST_F(ChosenSteps, FitLeafTilesIntoSixteenBitsWhereTheToleranceIsWide) {
  const Eigen::Vector3d step = lattice(10).step_m(0);
  EXPECT_GE(65535 * step.x(), 64.0 * 30);
  EXPECT_GE(65535 * step.z(), 4400.0);
}

TEST_F(ChosenSteps, AreAtLeastFourThousandAlongALeafTile) {
  const Eigen::Vector3d step = lattice(1000).step_m(0);
  EXPECT_GE(64 * 30 / step.x(), 4096);
  EXPECT_GE(4400 / step.z(), 4096);
}

TEST_F(ChosenSteps, AreNoFinerThanAThirtySecondOfTheTolerance) {
  const Eigen::Vector3d step = lattice(2).step_m(0);
  EXPECT_GE(step.x(), 2.0 / 32);
  EXPECT_GE(step.z(), 2.0 / 32);
}

TEST_F(ChosenSteps, AreASixteenthOfTheToleranceAtMost) {
  EXPECT_LE(lattice(0.1).step_m(0).maxCoeff(), 0.1 / 16);
}

TEST_F(ChosenSteps, ArePowersOfTwoAndMultiplesOfTheFinerLevels) {
  const Lattice chosen = lattice(0.3);
  for (int level = 0; level < pyramid_.level_count(); ++level) {
    for (int axis = 0; axis < 3; ++axis) {
      const double step = chosen.step_m(level)[axis];
      EXPECT_EQ(std::exp2(std::round(std::log2(step))), step);
      if (level == 0) continue;
      const double ratio = step / chosen.step_m(level - 1)[axis];
      EXPECT_EQ(ratio, std::round(ratio));
    }
  }
}

TEST_F(ChosenSteps, NeverCountMoreThanATileMaySpan) {
  const Lattice chosen = lattice(0.001);
  for (int level = 0; level < pyramid_.level_count(); ++level) {
    const double extent_m = std::min(1000.0, 64.0 * (1 << level)) * 30;
    EXPECT_LE(extent_m / chosen.step_m(level).x(), Lattice::kMostSteps) << level;
  }
}

}  // namespace
}  // namespace terrane::tiler

#include "tiler/lattice.h"

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

TEST(Lattice, ChosenStepsFitEveryTileIntoSixteenBits) {
  const PlainPlace place(30, 30);
  const Pyramid pyramid({1000, 700}, 64);
  const WorldFrame world(place, {1000, 700});
  const Lattice lattice(pyramid, world, {1, -100, 4300, ""});
  for (int level = 0; level < pyramid.level_count(); ++level) {
    const Eigen::Vector3d step = lattice.step_m(level);
    EXPECT_GE(65535 * step.x(), 64.0 * 30 * (1 << level)) << level;
    EXPECT_GE(65535 * step.z(), 4400.0) << level;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(std::exp2(std::round(std::log2(step[axis]))), step[axis]);
      if (level > 0) {
        const double ratio = step[axis] / lattice.step_m(level - 1)[axis];
        EXPECT_EQ(ratio, std::round(ratio));
      }
    }
  }
  // and no coarser than that: the next finer step would not fit
  EXPECT_LT(65535 * lattice.step_m(0).x() / 2, 64.0 * 30 * 1.08);
}

}  // namespace
}  // namespace terrane::tiler

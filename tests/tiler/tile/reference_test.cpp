#include "tiler/tile/reference.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/tiler/test_dem.h"
#include "tiler/tile/lattice.h"
#include "tiler/tile/world_frame.h"

namespace terrane::tiler {
namespace {

using testing::FunctionDem;
using testing::PlainPlace;

/// A slope with a spike and a pit in it, over so many samples that they are reduced.
double slope_with_spikes(std::int64_t column, std::int64_t row) {
  const auto slope = static_cast<double>(column) + 2 * static_cast<double>(row);
  if (column == 1000 && row == 777) return slope + 50;
  if (column == 2001 && row == 1500) return slope - 50;
  return slope;
}

class ReducedReference : public ::testing::Test {
 protected:
  FunctionDem dem_{{2200, 2200}, slope_with_spikes};
  PlainPlace place_{1, 1};
  Window window_{0, 0, 2200, 2200};
  WorldFrame world_{place_, dem_.shape()};
  Lattice lattice_{std::vector<Eigen::Vector3d>{{0.01, 0.01, 0.01}}};
  TileFrame frame_{world_, lattice_, window_, 0};
  TileSamples samples_{dem_, window_, 0, 100};
  Reference reference_{samples_, frame_, 1e-7};
  TileSamples backed_samples_{dem_, window_, 0, 100, nullptr, Behind::kAllSamples};

  bool holds(float column, float row) const {
    return std::ranges::any_of(reference_.field().kept, [&](const auto& sample) {
      return sample.column == column && sample.row == row;
    });
  }
};

TEST_F(ReducedReference, KeepsWhatSticksOutMostOfItsBlock) {
  ASSERT_TRUE(reference_.field().is_reduced());
  EXPECT_TRUE(holds(1000, 777));
  EXPECT_TRUE(holds(2001, 1500));
}

TEST_F(ReducedReference, KeepsTenSamplesOfEachBlockAtMost) {
  const GridShape blocks = reference_.field().blocks();
  EXPECT_LE(reference_.field().kept.size(),
            10 * static_cast<std::size_t>(blocks.columns * blocks.rows));
  EXPECT_GE(reference_.field().kept.size(), static_cast<std::size_t>(blocks.columns * blocks.rows));
}

TEST_F(ReducedReference, LearnsASampleOnce) {
  const std::vector<hierarchy::FieldSample> known{{1000, 777, 2604}};
  EXPECT_FALSE(reference_.learn(known));
  hierarchy::FieldSample fresh{};
  for (float column = 0; holds(column, 0); ++column) fresh.column = column + 1;
  EXPECT_TRUE(reference_.learn({fresh}));
  EXPECT_TRUE(holds(fresh.column, 0));
  EXPECT_FALSE(reference_.learn({fresh}));
}

TEST_F(ReducedReference, WhatItLeavesOutStaysBehindItIfMemoryAllows) {
  const Reference backed(backed_samples_, frame_, 1e-7);
  EXPECT_FALSE(reference_.is_whole());
  EXPECT_FALSE(reference_.field().is_backed());
  ASSERT_TRUE(backed.field().is_backed());
  EXPECT_TRUE(backed.is_whole());
  EXPECT_LT(backed.field().kept.size(), reference_.field().kept.size());
  EXPECT_NEAR(backed.field().behind.row(1000, 777)[0], slope_with_spikes(1000, 777),
              backed.field().behind.rounding_m() + 1e-3);
}

TEST_F(ReducedReference, WhatItsMemoryDoesNotAllowIsThereAsSlabs) {
  const Reference backed(backed_samples_, frame_, 1e-7, 1000);
  EXPECT_TRUE(backed.is_whole());
  EXPECT_TRUE(backed.field().behind.empty());
  const hierarchy::HeightSlabs& slabs = backed.field().slabs;
  ASSERT_FALSE(slabs.empty());
  const std::int64_t side = slabs.side();
  for (const auto& [column, row] : {std::pair{1000, 777}, {2001, 1500}, {2199, 2199}, {0, 0}}) {
    const hierarchy::HeightSlab& slab = slabs.at(column / side, row / side);
    const double middle_m = slab.middle_m(double(column % side), double(row % side));
    EXPECT_NEAR(middle_m, slope_with_spikes(column, row), slab.half_m + 1e-3);
  }
}

}  // namespace
}  // namespace terrane::tiler

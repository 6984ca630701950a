#include "tiler/raster/half_size.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace terrane::tiler {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

TEST(AddHalfSize, FillsItsQuarterWithMeansOfFour) {
  const std::vector<float> tile = {1, 2, 10, 20,  //
                                   3, 6, 30, 40,  //
                                   0, 0, 5,  5,   //
                                   0, 8, 5,  5};
  std::vector<float> coarser(16, -1);
  add_half_size(tile, 4, /*right=*/true, /*lower=*/false, coarser);
  EXPECT_EQ(coarser, (std::vector<float>{-1, -1, 3, 25,  //
                                         -1, -1, 2, 5,   //
                                         -1, -1, -1, -1, -1, -1, -1, -1}));
  add_half_size(tile, 4, false, true, coarser);
  EXPECT_EQ(coarser[8], 3);
  EXPECT_EQ(coarser[13], 5);
}

TEST(AddHalfSize, LeavesOutWhatHasNoData) {
  const std::vector<float> tile = {kNone, 2, kNone, kNone,  //
                                   4,     6, kNone, kNone,  //
                                   kNone, 7, 1,     1,      //
                                   kNone, 9, 1,     1};
  std::vector<float> coarser(16, 0);
  add_half_size(tile, 4, false, false, coarser);
  EXPECT_EQ(coarser[0], 4);
  EXPECT_TRUE(std::isnan(coarser[1]));
  EXPECT_EQ(coarser[4], 8);
  EXPECT_EQ(coarser[5], 1);
}

}  // namespace
}  // namespace terrane::tiler

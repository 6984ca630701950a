#include "hierarchy/collapse/coded_heights.h"

#include <gtest/gtest.h>

namespace terrane::hierarchy {
namespace {

TEST(CodedHeights, AreOffByTheirRoundingAtMost) {
  constexpr double kLowest = -431.7, kHighest = 8848.9;
  CodedHeights heights({1000, 1}, kLowest, kHighest);
  EXPECT_LE(heights.rounding_m(), (kHighest - kLowest) / 131'000);
  for (std::int64_t k = 0; k < 1000; ++k) {
    const double height_m = kLowest + (kHighest - kLowest) * double(k) / 999;
    heights.set(k, 0, height_m);
    EXPECT_NEAR(heights.row(k, 0)[0], height_m, heights.rounding_m() + 1e-9);
  }
}

TEST(CodedHeights, KeepHoles) {
  CodedHeights heights({2, 2}, 0, 10);
  heights.set(0, 1, 10);
  heights.set(1, 1, NAN);
  EXPECT_TRUE(std::isnan(heights.row(0, 0)[0]));
  EXPECT_EQ(heights.row(0, 1)[0], 10);
  EXPECT_TRUE(std::isnan(heights.row(0, 1)[1]));
}

TEST(CodedHeights, ThatAreAllTheSameLoseNothing) {
  CodedHeights heights({1, 1}, 1234.5, 1234.5);
  heights.set(0, 0, 1234.5);
  EXPECT_EQ(heights.row(0, 0)[0], 1234.5);
  EXPECT_LT(heights.rounding_m(), 1e-6);
}

}  // namespace
}  // namespace terrane::hierarchy

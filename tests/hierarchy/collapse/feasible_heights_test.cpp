#include "hierarchy/collapse/feasible_heights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tests/hierarchy/test_meshes.h"

namespace terrane::hierarchy {
namespace {

using testing::field_of;
using testing::grid_of;

constexpr FieldPoint kCorners[] = {{8, 4, 0}, {4, 0, 0}, {0, 4, 0}, {4, 8, 0}};

/// Takes in the four triangles around (4, 4); the corners are at height 0.
bool add_all(FeasibleHeights& heights) {
  for (int k = 0; k < 4; ++k) {
    if (!heights.add({4, 4, 0}, kCorners[k], kCorners[(k + 1) % 4])) return false;
  }
  return true;
}

double pyramid(std::int64_t column, std::int64_t row, double peak_m) {
  const auto away = std::abs(column - 4) + std::abs(row - 4);
  return peak_m * std::max(0.0, 1 - static_cast<double>(away) / 4);
}

TEST(FeasibleHeights, PyramidHasItsPeak) {
  const SampleField field =
      field_of(grid_of(9, 9, [](auto c, auto r) { return pyramid(c, r, 20); }));
  FeasibleHeights heights(field, 1);
  ASSERT_TRUE(add_all(heights));
  EXPECT_NEAR(heights.best_m().value(), 20, 1e-6);
}

TEST(FeasibleHeights, NoneIsLeftBetweenAPeakAndAPitBeside) {
  const SampleField field = field_of(grid_of(9, 9, [](auto c, auto r) {
    return c == 4 && r == 4 ? 10 : c == 5 && r == 4 ? -10 : 0;
  }));
  FeasibleHeights heights(field, 5);
  EXPECT_FALSE(add_all(heights));
}

TEST(FeasibleHeights, BestStaysAFifthAwayFromTheEndsOfTheInterval) {
  // the peak allows 0 to 20 m, its neighbours, which the centre moves by 3/4, at most 5 / 0.75;
  // the least squares are below 0
  const SampleField field =
      field_of(grid_of(9, 9, [](auto c, auto r) { return c == 4 && r == 4 ? 10 : -5; }));
  FeasibleHeights heights(field, 10);
  ASSERT_TRUE(add_all(heights));
  EXPECT_NEAR(heights.best_m().value(), 0.2 * 5 / 0.75, 1e-9);
}

TEST(FeasibleHeights, NothingDecidesWithoutSamples) {
  const SampleField field = field_of(grid_of(9, 9, [](auto, auto) { return NAN; }));
  FeasibleHeights heights(field, 1);
  ASSERT_TRUE(add_all(heights));
  EXPECT_FALSE(heights.best_m());
}

}  // namespace
}  // namespace terrane::hierarchy

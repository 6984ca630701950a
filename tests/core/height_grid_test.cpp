#include "core/height_grid.h"

#include <gtest/gtest.h>

namespace terrane {
namespace {

//        column 5  6  7
// row 8:        0  1  2
// row 9:        3  -  5
HeightGrid small_window() {
  return {.window = {5, 8, 3, 2}, .heights_m = {0, 1, 2, 3, kNoHeight, 5}};
}

TEST(HeightGrid, IsAskedByColumnAndRowOfTheDem) {
  const HeightGrid grid = small_window();
  EXPECT_EQ(grid.at(5, 8), 0.0F);
  EXPECT_EQ(grid.at(7, 8), 2.0F);
  EXPECT_EQ(grid.at(5, 9), 3.0F);
  EXPECT_EQ(grid.at(7, 9), 5.0F);
}

TEST(HeightGrid, KnowsWhereThereIsNoData) {
  EXPECT_FALSE(small_window().has_data(6, 9));
  EXPECT_TRUE(small_window().has_data(5, 8));  // a height of zero is one
}

}  // namespace
}  // namespace terrane

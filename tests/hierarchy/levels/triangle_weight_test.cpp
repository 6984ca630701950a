#include "hierarchy/levels/triangle_weight.h"

#include <gtest/gtest.h>

#include <cmath>

namespace terrane::hierarchy {
namespace {

TEST(TriangleWeight, AngleTermIsOneForAnEquilateralTriangleAndZeroForANeedle) {
  const TriangleShape equilateral = shape_of({0, 0, 0}, {2, 0, 0}, {1, std::sqrt(3.0), 0});
  EXPECT_NEAR(equilateral.angle, 1, 1e-12);
  EXPECT_NEAR(equilateral.area, std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(shape_of({0, 0, 0}, {1, 0, 0}, {2, 1e-9, 0}).angle, 0, 1e-6);
  EXPECT_EQ(shape_of({0, 0, 0}, {1, 0, 0}, {1, 0, 0}).area, 0);
}

TEST(TriangleWeight, AngleTermOfARightIsoscelesTriangleIsTwiceRootTwoLessOne) {
  EXPECT_NEAR(shape_of({0, 0, 0}, {1, 0, 0}, {0, 1, 0}).angle, 2 * (std::sqrt(2.0) - 1), 1e-12);
}

TEST(TriangleWeight, ValenceTermIsZeroForSixAndGrowsBothWays) {
  EXPECT_EQ(valence_term(6), 0);
  EXPECT_EQ(valence_term(9), valence_term(3));
  EXPECT_EQ(valence_term(18), 1);
}

}  // namespace
}  // namespace terrane::hierarchy

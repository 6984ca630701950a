#include "hierarchy/collapse/star_fit.h"

#include <gtest/gtest.h>

#include "tests/hierarchy/test_meshes.h"

namespace terrane::hierarchy {
namespace {

using testing::field_of;
using testing::grid_of;

/// The sides of a square of 2 n cells, counter-clockwise on the map, at height 0.
std::vector<StarSide> square(double n) {
  const FieldPoint a{0, 0, 0}, b{0, 2 * n, 0}, c{2 * n, 2 * n, 0}, d{2 * n, 0, 0};
  return {{a, b}, {b, c}, {c, d}, {d, a}};
}

TEST(StarFit, FindsThePeakOfAPyramidExactly) {
  const auto height = [](auto c, auto r) {
    return 10.0 * (4 - std::max(std::abs(c - 4), std::abs(r - 4)));
  };
  const SampleField field = field_of(grid_of(9, 9, height));
  const auto fit = fit_star(4, 4, square(4), field, 1, 0);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->height_m, 40, 1e-9);
  EXPECT_NEAR(fit->squared_error_m2, 0, 1e-9);
  // the peak itself is the tightest sample: it alone has the whole weight of the centre
  EXPECT_NEAR(fit->lowest_m, 39, 1e-9);
  EXPECT_NEAR(fit->highest_m, 41, 1e-9);
}

TEST(StarFit, RefusesWhereTwoSamplesCannotBothBeKept) {
  // a spike beside the centre and a pit on the other side: 10 m apart, 1 m tolerance
  const SampleField field = field_of(grid_of(9, 9, [](auto c, auto r) {
    return r != 4 ? 0 : c == 3 ? 5 : c == 5 ? -5 : 0;
  }));
  EXPECT_FALSE(fit_star(4, 4, square(4), field, 1, 0));
}

TEST(StarFit, SamplesWithoutDataConstrainNothing) {
  const SampleField field =
      field_of(grid_of(9, 9, [](auto c, auto r) { return c == 3 && r == 3 ? NAN : 0; }));
  const auto fit = fit_star(4, 4, square(4), field, 1, 0);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->height_m, 0, 1e-12);
}

TEST(StarFit, TakesTheFallbackWhereNoSampleLies) {
  const SampleField field = field_of(grid_of(3, 3, [](auto, auto) { return 0; }));
  const FieldPoint a{0.2, 0.2, 0}, b{0.3, 0.8, 0}, c{0.8, 0.3, 0};
  const auto fit = fit_star(0.4, 0.4, std::vector<StarSide>{{a, b}, {b, c}, {c, a}}, field, 1, 7);
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->height_m, 7);
}

TEST(IsWithin, SeesASampleOnTheEdgeOfTheTriangle) {
  const SampleField field =
      field_of(grid_of(5, 5, [](auto c, auto r) { return c == 2 && r == 0 ? 3 : 0; }));
  const FieldPoint a{0, 0, 0}, b{0, 4, 0}, c{4, 0, 0};
  EXPECT_FALSE(is_within(a, b, c, field, 2.9));
  EXPECT_TRUE(is_within(a, b, c, field, 3));
}

}  // namespace
}  // namespace terrane::hierarchy

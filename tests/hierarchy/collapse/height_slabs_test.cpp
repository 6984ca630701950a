#include "hierarchy/collapse/height_slabs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hierarchy/collapse/moving_triangle.h"
#include "hierarchy/collapse/sample_field.h"

namespace terrane::hierarchy {
namespace {

constexpr std::int64_t kColumns = 45, kRows = 38;  // the last blocks are cut off

/// Hills that are smooth here and rough there, with holes and a block without a height.
SampleField field_with_holes() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  SampleField field{kColumns, kRows, {}};
  for (std::int64_t row = 0; row < kRows; ++row) {
    for (std::int64_t column = 0; column < kColumns; ++column) {
      const bool is_hole = uniform(random) < 0.02 || (column / 8 == 2 && row / 8 == 1);
      const double rough_m = column > 20 ? 6 * uniform(random) : 0;
      const double height_m =
          500 + 9 * std::sin(0.2 * double(column)) * std::cos(0.15 * double(row)) + rough_m;
      field.heights_m.push_back(is_hole ? NAN : height_m);
    }
  }
  return field;
}

TEST(HeightSlabs, HoldAllHeightsOfTheirBlocks) {
  const SampleField field = field_with_holes();
  const HeightSlabs slabs = field.slabs_of_grid(8);
  for (std::int64_t row = 0; row < kRows; ++row) {
    for (std::int64_t column = 0; column < kColumns; ++column) {
      const double height_m = field.row(row)[column];
      if (std::isnan(height_m)) continue;
      const HeightSlab& slab = slabs.at(column / slabs.side(), row / slabs.side());
      const double middle_m =
          slab.middle_m(double(column % slabs.side()), double(row % slabs.side()));
      EXPECT_LE(std::abs(height_m - middle_m), slab.half_m) << column << ", " << row;
    }
  }
  EXPECT_TRUE(slabs.at(2, 1).is_empty());
}

TEST(HeightSlabs, AreThinWhereTheTerrainIsAPlane) {
  SampleField field{8, 8, {}};
  for (int k = 0; k < 64; ++k) field.heights_m.push_back(3 * (k % 8) - 2 * (k / 8));
  EXPECT_NEAR(field.slabs_of_grid(8).at(0, 0).half_m, 0, 1e-4);
}

using Triangle = std::array<FieldPoint, 3>;

double doubled_area(const Triangle& t) {
  return (t[2].column - t[0].column) * (t[1].row - t[0].row) -
         (t[1].column - t[0].column) * (t[2].row - t[0].row);
}

/// Calls visit(moving, tolerance in metres) for triangles that move over the field.
template <class Visit>
void for_each_moving_triangle(const Visit& visit) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  const auto point = [&] {
    return FieldPoint{(kColumns - 1) * uniform(random), (kRows - 1) * uniform(random),
                      490 + 25 * uniform(random)};
  };
  for (int n = 0; n < 4000; ++n) {
    const Triangle from{point(), point(), point()};
    if (doubled_area(from) < 20) continue;
    Triangle to = from;
    to[n % 3] = point();
    if (doubled_area(to) < 20) continue;
    visit(MovingTriangle(from, to, 1e-7), 4 + 26 * uniform(random));
  }
}

TEST(HeightSlabs, ChangeNoVerdictOnAMovingTriangle) {
  const SampleField field = field_with_holes();
  SampleField with = field;
  with.slabs = field.slabs_of_grid(8);
  int sound = 0, unsound = 0;
  for_each_moving_triangle([&](const MovingTriangle& moving, double tolerance_m) {
    const bool is_sound = moving.stays_within(field, tolerance_m);
    EXPECT_EQ(moving.stays_within(with, tolerance_m), is_sound);
    ++(is_sound ? sound : unsound);
  });
  EXPECT_GT(sound, 300);
  EXPECT_GT(unsound, 300);
}

TEST(HeightSlabs, WithoutTheirSamplesAllowNoMoreThanThese) {
  const SampleField field = field_with_holes();
  SampleField without{kColumns, kRows, {}};
  without.keep(8, {});
  without.slabs = field.slabs_of_grid(8);
  int sound = 0, unsound = 0, in_vain = 0;
  for_each_moving_triangle([&](const MovingTriangle& moving, double tolerance_m) {
    const bool is_sound = moving.stays_within(field, tolerance_m);
    const bool is_allowed = moving.stays_within(without, tolerance_m);
    EXPECT_TRUE(is_sound || !is_allowed);
    ++(is_allowed ? sound : is_sound ? in_vain : unsound);
  });
  EXPECT_GT(sound, 300);
  EXPECT_GT(unsound, 300);
  EXPECT_LT(in_vain, (sound + unsound) / 3);
}

}  // namespace
}  // namespace terrane::hierarchy

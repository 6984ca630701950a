#include "tiler/verify/water_samples.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/tiler/test_dem.h"

namespace terrane::verify {
namespace {

using tiler::testing::FunctionDem;
using tiler::testing::GeographicPlace;
using tiler::testing::PlainPlace;

constexpr GridShape kShape{100, 80};

/// Never the height of the water.
double slope(std::int64_t column, std::int64_t row) {
  return static_cast<double>(column + row) + 0.25;
}

/// Columns 20 to 60, rows 10 to 50, with an island of columns 30 to 40, rows 20 to 30; as seen by
/// samples, with shores half-way to the next ones.
bool is_wet(std::int64_t column, std::int64_t row) {
  const auto within = [&](std::int64_t from_column, std::int64_t to_column, std::int64_t from_row,
                          std::int64_t to_row) {
    return column >= from_column && column <= to_column && row >= from_row && row <= to_row;
  };
  return within(20, 60, 10, 50) && !within(30, 40, 20, 30);
}

template <class ToPlan>
WaterArea lake(const ToPlan& to_plan) {
  const auto ring = [&](double left, double right, double top, double bottom) {
    return std::vector<PlanPosition>{to_plan({left, top}), to_plan({right, top}),
                                     to_plan({right, bottom}), to_plan({left, bottom})};
  };
  return {{ring(19.5, 60.5, 9.5, 50.5), ring(29.5, 40.5, 19.5, 30.5)}};
}

WaterFindings findings(const FunctionDem::Height& reference, double tolerance_m = 1) {
  const PlainPlace place(10, 10);
  const WaterArea area = lake([&](GridPosition p) { return place.to_plan(p); });
  return check_water(FunctionDem(kShape, slope), FunctionDem(kShape, reference), place,
                     std::vector{area}, tolerance_m);
}

double levelled(std::int64_t column, std::int64_t row) {
  return is_wet(column, row) ? 77 : slope(column, row);
}

TEST(CheckWater, AgreesWithAReferenceThatIsFlatInWaterAndTheDemOnLand) {
  const WaterFindings found = findings(levelled);
  EXPECT_EQ(found.wrong, 0);
  EXPECT_EQ(found.under_water, 41 * 41 - 11 * 11);
}

TEST(CheckWater, FindsWaterThatIsNotFlatAndIslandsAndLandThatWereFlooded) {
  const auto but_at = [](std::int64_t c, std::int64_t r, double height_m) {
    return findings([=](std::int64_t column, std::int64_t row) {
             return column == c && row == r ? height_m : levelled(column, row);
           })
        .wrong;
  };
  EXPECT_EQ(but_at(50, 40, 77.01), 1);
  EXPECT_EQ(but_at(50, 40, NAN), 1);
  EXPECT_EQ(but_at(35, 25, 77), 1);
  EXPECT_EQ(but_at(61, 30, 77), 1);
  EXPECT_EQ(but_at(99, 79, 77), 1);
}

TEST(CheckWater, LeavesTheToleranceAroundShoresAlone) {
  const auto wider_by_one = [](std::int64_t column, std::int64_t row) {
    return column == 61 && row >= 10 && row <= 50 ? 77 : levelled(column, row);
  };
  EXPECT_EQ(findings(wider_by_one, 4.9).wrong, 41);  // half a cell of 10 m from the shore
  EXPECT_EQ(findings(wider_by_one, 5.1).wrong, 0);
}

TEST(CheckWater, TakesLongitudesAndLatitudesWhereTheDemHasACrs) {
  const GeographicPlace place({-122.1, 42.9}, 0.001);
  const WaterArea area = lake([&](GridPosition p) { return place.to_plan(p); });
  const WaterFindings found = check_water(FunctionDem(kShape, slope), FunctionDem(kShape, levelled),
                                          place, std::vector{area}, 1);
  EXPECT_EQ(found.wrong, 0);
  EXPECT_EQ(found.under_water, 41 * 41 - 11 * 11);
}

}  // namespace
}  // namespace terrane::verify

#include "ingest/synthetic.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/errors.h"
#include "ingest/scan.h"
#include "small_raster.h"

namespace terrane::ingest {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::input_error_of;
using testing::open_quietly;
using testing::read_all;

std::int64_t samples_at(const HeightGrid& grid, float height_m) {
  return std::count(grid.heights_m.begin(), grid.heights_m.end(), height_m);
}

TEST(Synthetic, PlaneAndFlatAreWhatTheySay) {
  const HeightGrid plane = read_all(*open_quietly("synthetic:plane?size=5&spacing=20"));
  EXPECT_EQ(plane.at(0, 0), 0.0F);
  EXPECT_EQ(plane.at(4, 0), 8.0F);   // 80 m to the east
  EXPECT_EQ(plane.at(0, 4), -4.0F);  // 80 m to the south
  const HeightGrid flat = read_all(*open_quietly("synthetic:flat?columns=3&rows=7"));
  EXPECT_EQ(flat.window, (Window{0, 0, 3, 7}));
  EXPECT_EQ(samples_at(flat, 100), 21);
}

TEST(Synthetic, LiesInLocalMetresWithRowsToTheSouth) {
  const auto dem = open_quietly("synthetic:flat?size=5&spacing=2.5");
  EXPECT_EQ(dem->place().crs_wkt(), "");
  EXPECT_EQ(dem->place().to_plan({0, 0}).x, 0);
  EXPECT_EQ(dem->place().to_plan({4, 4}).x, 10);
  EXPECT_EQ(dem->place().to_plan({4, 4}).y, -10);
  EXPECT_EQ(dem->description().column_spacing, 2.5);
}

TEST(Synthetic, CalderaHasAFlatLakeAroundAnIslandInsideARim) {
  const HeightGrid grid = read_all(*open_quietly("synthetic:caldera"));
  ASSERT_EQ(grid.window, (Window{0, 0, 513, 513}));
  // on the row of the island's top: outside, rim, lake, island, lake, rim
  const std::int64_t row = 236;
  EXPECT_GT(grid.at(128, row), 1200.0F);
  EXPECT_EQ(grid.at(230, row), 800.0F);
  EXPECT_GT(grid.at(287, row), 900.0F);
  EXPECT_EQ(grid.at(340, row), 800.0F);
  EXPECT_GT(grid.at(384, row), 1200.0F);
  EXPECT_GT(samples_at(grid, 800), 20000);
  EXPECT_LT(*std::min_element(grid.heights_m.begin(), grid.heights_m.end()), 700.0F);
}

// Computed by an independent program (Python, whose floats are IEEE doubles).
TEST(Synthetic, CalderaHasTheSameBitsEverywhere) {
  const HeightGrid grid = read_all(*open_quietly("synthetic:caldera?size=65&seed=7"));
  EXPECT_EQ(grid.at(0, 0), 0x1.37043e0000000p+9F);
  EXPECT_EQ(grid.at(64, 64), 0x1.29702c0000000p+9F);
  EXPECT_EQ(grid.at(17, 30), 0x1.7ec2500000000p+10F);
  EXPECT_EQ(grid.at(36, 29), 0x1.16e11c0000000p+10F);
  EXPECT_EQ(grid.at(40, 50), 0x1.67f2da0000000p+10F);
  EXPECT_EQ(grid.at(3, 59), 0x1.28595a0000000p+9F);
  EXPECT_EQ(grid.at(32, 10), 0x1.3cd38e0000000p+10F);
  EXPECT_EQ(grid.at(25, 32), 0x1.9000000000000p+9F);
}

TEST(Synthetic, SeedsGiveOtherHills) {
  const HeightGrid one = read_all(*open_quietly("synthetic:caldera?size=33&seed=1"));
  const HeightGrid two = read_all(*open_quietly("synthetic:caldera?size=33&seed=2"));
  EXPECT_NE(one.at(1, 1), two.at(1, 1));
  EXPECT_EQ(one.heights_m, read_all(*open_quietly("synthetic:caldera?size=33")).heights_m);
}

TEST(Synthetic, GivesTheSameBitsThroughEveryWindow) {
  const auto dem = open_quietly("synthetic:caldera?size=65&holes=5");
  const HeightGrid whole = read_all(*dem);
  const HeightGrid part = dem->heights().read({13, 40, 20, 10});
  for (std::int64_t r = 40; r < 50; ++r) {
    for (std::int64_t c = 13; c < 33; ++c) {
      const float a = part.at(c, r);
      const float b = whole.at(c, r);
      EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0);
    }
  }
}

TEST(Synthetic, HolesAreRoundAndWithoutData) {
  NoProgress progress;
  const auto whole = scan_heights(*open_quietly("synthetic:flat?size=200"), progress);
  EXPECT_EQ(whole.samples_with_data, 200 * 200);
  const auto one = scan_heights(*open_quietly("synthetic:flat?size=200&holes=1&seed=3"), progress);
  const auto missing = static_cast<double>(200 * 200 - one.samples_with_data);
  // at most a circle of 4 % of the side for radius
  EXPECT_GT(missing, 0);
  EXPECT_LT(missing, 3.15 * 8 * 8 + 40);
  const auto ten = scan_heights(*open_quietly("synthetic:flat?size=200&holes=10"), progress);
  EXPECT_LT(ten.samples_with_data, one.samples_with_data);
}

TEST(Synthetic, RefusesWhatItDoesNotKnow) {
  const auto error = [](const std::string& source) {
    return input_error_of([&] { open_quietly(source); });
  };
  EXPECT_THAT(error("synthetic:volcano"),
              AllOf(HasSubstr("'volcano'"), HasSubstr("caldera, plane or flat")));
  EXPECT_THAT(error("synthetic:caldera?colour=red"),
              AllOf(HasSubstr("synthetic:caldera?colour=red"), HasSubstr("'colour'"),
                    HasSubstr("size, columns, rows, spacing, seed or holes")));
  EXPECT_THAT(error("synthetic:caldera?size=1"), HasSubstr("from 2 to 100000"));
  EXPECT_THAT(error("synthetic:caldera?size=12x"), HasSubstr("size is '12x'"));
  EXPECT_THAT(error("synthetic:caldera?spacing=nan"), HasSubstr("spacing is 'nan'"));
  EXPECT_THAT(error("synthetic:caldera?seed=-1"), HasSubstr("seed is '-1'"));
  EXPECT_THAT(error("synthetic:caldera?size"), HasSubstr("size is ''"));
}

TEST(Synthetic, RefusesOptionsThatDescribeFiles) {
  EXPECT_THAT(input_error_of([] { open_quietly("synthetic:flat", {.crs = "EPSG:4326"}); }),
              AllOf(HasSubstr("synthetic:flat"), HasSubstr("--crs")));
  EXPECT_THAT(input_error_of([] { open_quietly("synthetic:flat", {.band = 2}); }),
              HasSubstr("--band"));
}

TEST(Synthetic, MakesNoMosaic) {
  NoProgress progress;
  EXPECT_THAT(input_error_of([&] {
                open_dem({"synthetic:flat", "synthetic:plane"}, {}, progress);
              }),
              HasSubstr("makes no mosaic"));
}

}  // namespace
}  // namespace terrane::ingest

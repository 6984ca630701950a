#include "ingest/mosaic.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.h"
#include "small_raster.h"

namespace terrane::ingest {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::input_error_of;
using testing::north_up;
using testing::RasterFolder;
using testing::read_all;
using testing::SmallRaster;

// 4 x 3 samples of one height, 10 m apart, corner at (x, y)
SmallRaster plateau(double x, double y, double height) {
  return {.type = "Int16",
          .value = [height](int, int) { return height; },
          .geotransform = north_up(x, y, 10),
          .crs = "EPSG:32610"};
}

std::unique_ptr<Dem> open_all(const std::vector<std::string>& files,
                              const OpenOptions& options = {}) {
  NoProgress progress;
  return open_dem(files, options, progress);
}

TEST(Mosaic, CoversAllFilesWhateverTheirOrder) {
  const RasterFolder folder;
  const std::string east = folder.write("east.tif", plateau(500040, 4000000, 2));
  const std::string west = folder.write("west.tif", plateau(500000, 4000020, 1));
  const auto dem = open_all({east, west});
  //  west  1 1 1 1 . . . .
  //        1 1 1 1 . . . .
  //        1 1 1 1 2 2 2 2
  //        . . . . 2 2 2 2  east
  //        . . . . 2 2 2 2
  ASSERT_EQ(dem->heights().shape(), (GridShape{8, 5}));
  EXPECT_EQ(dem->name(), "east.tif and 1 more");
  const HeightGrid grid = read_all(*dem);
  EXPECT_EQ(grid.at(0, 0), 1.0F);
  EXPECT_EQ(grid.at(3, 2), 1.0F);
  EXPECT_EQ(grid.at(4, 2), 2.0F);
  EXPECT_EQ(grid.at(7, 4), 2.0F);
  EXPECT_EQ(dem->place().to_plan({0, 0}).x, 500005);
  EXPECT_EQ(dem->place().to_plan({0, 0}).y, 4000015);
}

TEST(Mosaic, HasNoHeightsBetweenFilesThatDeclareNoNodata) {
  const RasterFolder folder;
  const auto dem = open_all({folder.write("a.tif", plateau(500000, 4000000, 1)),
                             folder.write("b.tif", plateau(500060, 4000000, 2))});
  const HeightGrid grid = read_all(*dem);
  ASSERT_EQ(grid.window.columns, 10);
  EXPECT_TRUE(grid.has_data(3, 1));
  EXPECT_FALSE(grid.has_data(4, 1));
  EXPECT_FALSE(grid.has_data(5, 1));
  EXPECT_TRUE(grid.has_data(6, 1));
}

TEST(Mosaic, ShowsTheLaterFileOnTopButNotItsVoids) {
  const RasterFolder folder;
  SmallRaster top = plateau(500020, 4000000, 2);
  top.nodata = -32768;
  top.value = [](int c, int) { return c == 0 ? -32768 : 2; };
  const auto dem =
      open_all({folder.write("a.tif", plateau(500000, 4000000, 1)), folder.write("b.tif", top)});
  const HeightGrid grid = read_all(*dem);
  EXPECT_EQ(grid.at(1, 1), 1.0F);
  EXPECT_EQ(grid.at(2, 1), 1.0F);  // a void of b over a
  EXPECT_EQ(grid.at(3, 1), 2.0F);  // both have one
}

TEST(Mosaic, ReadsEachFileWithItsOwnNodataAndUnit) {
  const RasterFolder folder;
  SmallRaster feet = plateau(500040, 4000000, 100);
  feet.unit = "ft";
  SmallRaster voids = plateau(500000, 4000000, -1);
  voids.nodata = -1;
  const auto dem = open_all({folder.write("a.tif", voids), folder.write("b.tif", feet)});
  const HeightGrid grid = read_all(*dem);
  EXPECT_FALSE(grid.has_data(0, 0));
  EXPECT_EQ(grid.at(4, 0), 30.48F);
}

TEST(Mosaic, JoinsRotatedGrids) {
  const RasterFolder folder;
  SmallRaster a = plateau(0, 0, 1);
  SmallRaster b = plateau(0, 0, 2);
  a.geotransform = {500000, 3, 4, 4000000, 4, -3};
  b.geotransform = {500000 + 4 * 3, 3, 4, 4000000 + 4 * 4, 4, -3};  // 4 columns on
  const auto dem = open_all({folder.write("a.tif", a), folder.write("b.tif", b)});
  EXPECT_EQ(dem->heights().shape(), (GridShape{8, 3}));
  EXPECT_EQ(read_all(*dem).at(4, 0), 2.0F);
}

TEST(Mosaic, GivesTheSameBitsThroughEveryWindow) {
  const RasterFolder folder;
  SmallRaster b = plateau(500020, 3999990, 0);
  b.value = [](int c, int r) { return 10 * r + c; };
  const auto dem =
      open_all({folder.write("a.tif", plateau(500000, 4000000, 1)), folder.write("b.tif", b)});
  const HeightGrid whole = read_all(*dem);
  for (std::int64_t row = 0; row < whole.window.rows; ++row) {
    for (std::int64_t column = 0; column < whole.window.columns; ++column) {
      const float alone = dem->heights().read({column, row, 1, 1}).heights_m.front();
      EXPECT_THAT(alone, ::testing::NanSensitiveFloatEq(whole.at(column, row)));
    }
  }
}

TEST(Mosaic, WorksWithMoreFilesThanStayOpen) {
  const RasterFolder folder;
  std::vector<std::string> files;
  for (int i = 0; i < 150; ++i) {
    files.push_back(folder.write(fmt::format("{}.tif", i), plateau(500000 + 40 * i, 4000000, i)));
  }
  const auto dem = open_all(files);
  for (int round = 0; round < 2; ++round) {
    const HeightGrid grid = read_all(*dem);
    for (int i = 0; i < 150; ++i) EXPECT_EQ(grid.at(4 * i, 1), static_cast<float>(i));
  }
}

std::string misfit_of(const SmallRaster& other) {
  const RasterFolder folder;
  const std::string a = folder.write("a.tif", plateau(500000, 4000000, 1));
  const std::string b = folder.write("b.tif", other);
  return input_error_of([&] { open_all({a, b}); });
}

TEST(Mosaic, RefusesAnotherCrs) {
  SmallRaster other = plateau(500000, 4000000, 1);
  other.crs = "EPSG:32611";
  EXPECT_THAT(misfit_of(other), AllOf(HasSubstr("b.tif: does not fit"), HasSubstr("a.tif"),
                                      HasSubstr("UTM zone 11N"), HasSubstr("gdalwarp")));
}

TEST(Mosaic, RefusesAFileWithoutCrsAmongOthers) {
  SmallRaster other = plateau(500000, 4000000, 1);
  other.crs = "";
  EXPECT_THAT(misfit_of(other), HasSubstr("its CRS is none, not WGS 84 / UTM zone 10N"));
}

TEST(Mosaic, RefusesAnotherNumberOfBands) {
  const RasterFolder folder;
  SmallRaster two = plateau(500000, 4000000, 1);
  two.bands = 2;
  const std::string a = folder.write("a.tif", plateau(500000, 4000000, 1));
  const std::string b = folder.write("b.tif", two);
  EXPECT_THAT(input_error_of([&] {
                open_all({a, b}, {.band = 1});
              }),
              HasSubstr("it has 2 bands, not 1"));
}

TEST(Mosaic, RefusesCellsThatLieBetweenTheFirstOnes) {
  EXPECT_THAT(misfit_of(plateau(500005, 4000000, 1)), HasSubstr("0.5 cells beside"));
  SmallRaster other = plateau(500040, 4000000, 1);
  other.geotransform = north_up(500040, 4000000, 10.1);
  EXPECT_THAT(misfit_of(other), HasSubstr("cells beside"));
}

TEST(Mosaic, TakesOriginsThatAreRoundedInTheFile) {
  EXPECT_EQ(misfit_of(plateau(500040.0001, 4000000, 1)), "no error");
}

TEST(Mosaic, RefusesFilesWithoutAPlace) {
  SmallRaster other = plateau(500000, 4000000, 1);
  other.geotransform.reset();
  EXPECT_THAT(misfit_of(other), HasSubstr("without a geotransform"));
}

}  // namespace
}  // namespace terrane::ingest

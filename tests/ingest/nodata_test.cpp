#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <limits>

#include "ingest/dem.h"
#include "small_raster.h"

namespace terrane::ingest {
namespace {

using testing::open_quietly;
using testing::RasterFolder;
using testing::read_all;
using testing::SmallRaster;

// 500 everywhere but for sample (1, 1)
SmallRaster with_sample(double value, const std::string& type = "Float32") {
  return {.type = type, .value = [value](int c, int r) { return c == 1 && r == 1 ? value : 500; }};
}

void expect_only_sample_1_1_missing(const Dem& dem) {
  const HeightGrid grid = read_all(dem);
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) {
      EXPECT_EQ(grid.has_data(c, r), c != 1 || r != 1) << c << ", " << r;
    }
  }
}

TEST(Nodata, IsWhatTheBandDeclares) {
  const RasterFolder folder;
  SmallRaster raster = with_sample(-32767, "Int16");
  raster.nodata = -32767;
  const auto dem = open_quietly(folder.write("a.tif", raster));
  expect_only_sample_1_1_missing(*dem);
  EXPECT_EQ(dem->description().nodata_origin, "the band");
}

TEST(Nodata, OfTheOptionWinsOverTheBand) {
  const RasterFolder folder;
  SmallRaster raster = with_sample(7, "Int16");
  raster.nodata = 500;
  const auto dem = open_quietly(folder.write("a.tif", raster), {.nodata = "7"});
  expect_only_sample_1_1_missing(*dem);
}

TEST(Nodata, NoneReadsEveryFiniteValueAsAHeight) {
  const RasterFolder folder;
  SmallRaster raster = with_sample(-32767, "Int16");
  raster.nodata = -32767;
  raster.masked = {{0, 0}};
  const auto dem = open_quietly(folder.write("a.tif", raster), {.nodata = "none"});
  EXPECT_EQ(read_all(*dem).at(1, 1), -32767.0F);
  EXPECT_EQ(read_all(*dem).at(0, 0), 500.0F);
  EXPECT_TRUE(dem->suspects().empty());
}

TEST(Nodata, IsAlsoNanAndInfinityWithoutDeclaration) {
  const RasterFolder folder;
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double value : {std::nan(""), infinity, -infinity}) {
    expect_only_sample_1_1_missing(
        *open_quietly(folder.write("a.tif", with_sample(value)), {.nodata = "none"}));
  }
}

TEST(Nodata, MeetsItsSamplesWhenDeclaredWithMoreDigitsThanAFloatHas) {
  const RasterFolder folder;
  SmallRaster raster = with_sample(static_cast<double>(-9999.9F));
  raster.nodata = -9999.9;
  expect_only_sample_1_1_missing(*open_quietly(folder.write("a.tif", raster)));
}

TEST(Nodata, MeetsTheLowestFloat) {
  const RasterFolder folder;
  SmallRaster raster = with_sample(-FLT_MAX);
  raster.nodata = -FLT_MAX;
  expect_only_sample_1_1_missing(*open_quietly(folder.write("a.tif", raster)));
}

TEST(Nodata, OfA64BitBandIsFound) {
  const RasterFolder folder;
  SmallRaster raster = with_sample(-9223372036854775807.0 - 1, "Int64");
  raster.nodata = -9223372036854775807.0 - 1;
  expect_only_sample_1_1_missing(*open_quietly(folder.write("a.tif", raster)));
}

TEST(Nodata, IsWhereTheMaskSaysSo) {
  const RasterFolder folder;
  SmallRaster raster = with_sample(500, "Int16");
  raster.masked = {{1, 1}};
  const auto dem = open_quietly(folder.write("a.tif", raster));
  expect_only_sample_1_1_missing(*dem);
  EXPECT_EQ(dem->description().nodata_origin, "a mask");
}

TEST(Nodata, OfTheOptionKeepsTheMask) {
  const RasterFolder folder;
  SmallRaster raster = with_sample(500, "Int16");
  raster.masked = {{1, 1}};
  expect_only_sample_1_1_missing(*open_quietly(folder.write("a.tif", raster), {.nodata = "-9999"}));
}

TEST(Nodata, OfABandWithAnAlphaBandIsWhereAlphaIsZero) {
  const RasterFolder folder;
  // the second band, alpha, holds 1000 more than the first: 0 at (1, 1), where the first has its 0
  // because UInt16 ends there
  const SmallRaster raster = {.bands = 2,
                              .type = "UInt16",
                              .value = [](int c, int r) { return c == 1 && r == 1 ? -1000 : 5; },
                              .creation_options = {"ALPHA=YES"}};
  const auto dem = open_quietly(folder.write("a.tif", raster), {.band = 1});
  expect_only_sample_1_1_missing(*dem);
}

TEST(Nodata, IsComparedAsStoredAndNotAsHeight) {
  const RasterFolder folder;
  SmallRaster raster = with_sample(-9999, "Int16");
  raster.nodata = -9999;
  raster.scale = 0.1;
  raster.offset = 10;
  raster.unit = "ft";
  const auto dem = open_quietly(folder.write("a.tif", raster));
  expect_only_sample_1_1_missing(*dem);
  EXPECT_EQ(read_all(*dem).at(0, 0), static_cast<float>((500 * 0.1 + 10) * 0.3048));
}

}  // namespace
}  // namespace terrane::ingest

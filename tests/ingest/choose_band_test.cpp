#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ingest/dem.h"
#include "small_raster.h"

namespace terrane::ingest {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::input_error_of;
using ::testing::Not;
using testing::open_quietly;
using testing::RasterFolder;
using testing::read_all;

TEST(ChooseBand, TakesTheOnlyOne) {
  const RasterFolder folder;
  const auto dem = open_quietly(folder.write("one.tif", {}));
  EXPECT_EQ(dem->description().band, 1);
  EXPECT_EQ(read_all(*dem).at(3, 2), 11.0F);
}

TEST(ChooseBand, ReadsTheOneAskedFor) {
  const RasterFolder folder;
  const auto dem = open_quietly(folder.write("three.tif", {.bands = 3}), {.band = 3});
  EXPECT_EQ(dem->description().band, 3);
  EXPECT_EQ(dem->description().band_count, 3);
  EXPECT_EQ(read_all(*dem).at(3, 2), 2011.0F);
}

TEST(ChooseBand, AsksWhereThereAreSeveral) {
  const RasterFolder folder;
  const std::string file = folder.write("two.tif", {.bands = 2, .type = "Int16"});
  EXPECT_THAT(input_error_of([&] { open_quietly(file); }),
              AllOf(HasSubstr("two.tif: has 2 bands"), HasSubstr("--band N (1 to 2)"),
                    Not(HasSubstr("image"))));
}

TEST(ChooseBand, RefusesANumberOutOfRange) {
  const RasterFolder folder;
  const std::string file = folder.write("two.tif", {.bands = 2});
  for (const int band : {0, 3, -1}) {
    EXPECT_THAT(input_error_of([&] { open_quietly(file, {.band = band}); }),
                AllOf(HasSubstr("two.tif"), HasSubstr("--band takes 1 to 2")));
  }
}

TEST(ChooseBand, KnowsAnImageByItsColours) {
  const RasterFolder folder;
  const std::string file = folder.write("photo.tif", {.bands = 3,
                                                      .type = "Byte",
                                                      .value = [](int, int) { return 7; },
                                                      .colours = "rgb",
                                                      .creation_options = {"PHOTOMETRIC=RGB"}});
  EXPECT_THAT(input_error_of([&] { open_quietly(file); }),
              AllOf(HasSubstr("photo.tif: has 3 bands"), HasSubstr("looks like an image"),
                    HasSubstr("--band N")));
  EXPECT_EQ(open_quietly(file, {.band = 1})->description().band, 1);
}

TEST(ChooseBand, KnowsAnImageByItsPalette) {
  const RasterFolder folder;
  const std::string file = folder.write("map.tif", {.type = "Byte", .colours = "palette"});
  EXPECT_THAT(input_error_of([&] { open_quietly(file); }),
              AllOf(HasSubstr("map.tif: looks like an image"), HasSubstr("--band 1")));
  EXPECT_EQ(read_all(*open_quietly(file, {.band = 1})).at(1, 0), 1.0F);
}

TEST(ChooseBand, TakesAGreyByteBandForHeights) {
  const RasterFolder folder;
  const auto dem = open_quietly(folder.write("grey.tif", {.type = "Byte"}));
  EXPECT_EQ(read_all(*dem).at(2, 0), 2.0F);
}

}  // namespace
}  // namespace terrane::ingest

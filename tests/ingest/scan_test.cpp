#include "ingest/scan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <filesystem>

#include "core/errors.h"
#include "small_raster.h"

namespace terrane::ingest {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::input_error_of;
using testing::north_up;
using ::testing::Not;
using testing::open_quietly;
using testing::RasterFolder;
using testing::RecordingProgress;
using testing::SmallRaster;

HeightStatistics scan(const std::string& file, const OpenOptions& options = {}) {
  NoProgress progress;
  return scan_heights(*open_quietly(file, options), progress);
}

std::string scan_error(const std::string& file, const OpenOptions& options = {}) {
  return input_error_of([&] { scan(file, options); });
}

// 60 x 50 heights, and `count` samples that hold `value` instead
SmallRaster with_samples(double value, int count, const std::string& type = "Int16") {
  return {.columns = 60, .rows = 50, .type = type, .value = [=](int c, int r) {
            return r * 60 + c < count ? value : 100.0 + r;
          }};
}

TEST(ScanHeights, FindsTheExtremesAndCountsWhatIsThere) {
  const RasterFolder folder;
  SmallRaster raster = with_samples(-32768, 7);
  raster.nodata = -32768;
  raster.unit = "ft";
  const HeightStatistics statistics = scan(folder.write("a.tif", raster));
  EXPECT_EQ(statistics.samples_with_data, 60 * 50 - 7);
  EXPECT_EQ(statistics.min_height_m, static_cast<double>(30.48F));
  EXPECT_EQ(statistics.max_height_m, static_cast<double>(static_cast<float>(149 * 0.3048)));
}

TEST(ScanHeights, TakesHeightsBelowZero) {
  const RasterFolder folder;
  const HeightStatistics statistics = scan(folder.write("a.tif", with_samples(-430, 1)));
  EXPECT_EQ(statistics.min_height_m, -430);
}

TEST(ScanHeights, ReportsEveryRow) {
  const RasterFolder folder;
  RecordingProgress progress;
  scan_heights(*open_quietly(folder.write("a.tif", with_samples(1, 1))), progress);
  EXPECT_EQ(progress.total(), 50);
  EXPECT_EQ(progress.done(), 50);
}

TEST(ScanHeights, RefusesAGridWithoutHeights) {
  const RasterFolder folder;
  SmallRaster raster = with_samples(-9999, 3000);
  raster.nodata = -9999;
  EXPECT_THAT(scan_error(folder.write("void.tif", raster)),
              AllOf(HasSubstr("void.tif: no sample holds a height"), HasSubstr("--nodata")));
}

TEST(ScanHeights, SuspectsUndeclaredNodataAndSaysWhatToDo) {
  const RasterFolder folder;
  for (const char* value : {"-32767", "-32768", "-9999"}) {
    const std::string file = folder.write("a.tif", with_samples(std::stod(value), 1234));
    EXPECT_THAT(scan_error(file),
                AllOf(HasSubstr(std::string("a.tif: 1,234 samples hold ") + value),
                      HasSubstr(std::string("Use --nodata ") + value + ", or --nodata none")));
    EXPECT_EQ(scan(file, {.nodata = value}).samples_with_data, 3000 - 1234);
    EXPECT_EQ(scan(file, {.nodata = "none"}).samples_with_data, 3000);
  }
}

TEST(ScanHeights, SuspectsTheLowestFloatHoweverItIsRounded) {
  const RasterFolder folder;
  for (const double value : {-3.4e38, -3.40282306e38, static_cast<double>(-FLT_MAX)}) {
    const std::string file = folder.write("a.tif", with_samples(value, 5, "Float32"));
    EXPECT_THAT(scan_error(file), HasSubstr("5 samples hold -3.4e38"));
    EXPECT_EQ(scan(file, {.nodata = "-3.4e38"}).samples_with_data, 2995);
  }
}

TEST(ScanHeights, SuspectsStoredValuesAndNotHeights) {
  const RasterFolder folder;
  SmallRaster feet = with_samples(-9999, 5);
  feet.unit = "ft";
  EXPECT_THAT(scan_error(folder.write("feet.tif", feet)), HasSubstr("5 samples hold -9999"));

  SmallRaster scaled = with_samples(-9999, 5);
  scaled.scale = 0.1;
  scaled.offset = 500;
  EXPECT_THAT(scan_error(folder.write("scaled.tif", scaled)), HasSubstr("5 samples hold -9999"));

  SmallRaster deep = with_samples(-99990, 5, "Int32");
  deep.scale = 0.1;  // -9999 m: a deep sea
  EXPECT_EQ(scan_error(folder.write("deep.tif", deep)), "no error");
}

TEST(ScanHeights, ProposesToKeepTheDeclaredNodata) {
  const RasterFolder folder;
  SmallRaster raster = with_samples(-32767, 5);
  raster.nodata = -9999;
  const std::string file = folder.write("two.tif", raster);
  EXPECT_THAT(scan_error(file), HasSubstr("Use --nodata -9999,-32767,"));
  EXPECT_EQ(scan_error(file, {.nodata = "-9999,-32767"}), "no error");
}

TEST(ScanHeights, NamesEveryValueItSuspects) {
  const RasterFolder folder;
  SmallRaster raster = with_samples(0, 0);
  raster.value = [](int c, int r) { return r > 0 ? 10 : c < 20 ? -9999 : -32768; };
  EXPECT_THAT(scan_error(folder.write("a.tif", raster)),
              AllOf(HasSubstr("40 samples hold -32768 and 20 samples hold -9999"),
                    HasSubstr("--nodata -32768,-9999")));
}

TEST(ScanHeights, SuspectsNothingThatIsDeclared) {
  const RasterFolder folder;
  SmallRaster raster = with_samples(-32767, 5);
  raster.nodata = -32767;
  EXPECT_EQ(scan_error(folder.write("a.tif", raster)), "no error");
}

TEST(ScanHeights, NamesTheFileThatEndsTooEarly) {
  const RasterFolder folder;
  const std::string file = folder.write("cut.tif", {.columns = 100, .rows = 400});
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  EXPECT_THAT(scan_error(file),
              AllOf(HasSubstr("cut.tif: cannot read columns"), Not(HasSubstr("\n"))));
}

TEST(FingerprintOfADem, IsThatOfTheHeightsAndNotOfTheFormat) {
  const RasterFolder folder;
  SmallRaster strips = with_samples(-5, 9);
  strips.nodata = -5;
  SmallRaster tiles = with_samples(1e20, 9, "Float32");  // other type, nodata and blocks
  tiles.nodata = 1e20;
  tiles.creation_options = {"TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=16"};
  EXPECT_EQ(scan(folder.write("a.tif", strips)).fingerprint,
            scan(folder.write("b.tif", tiles)).fingerprint);
}

TEST(FingerprintOfADem, DoesNotDependOnTheWidthOfTheChunks) {
  const RasterFolder folder;
  // blocks of 512 x 512 are read in pieces of 2,048 columns, strips in whole rows
  SmallRaster strips = {
      .columns = 6000, .rows = 300, .value = [](int c, int r) { return std::sqrt(c) + r; }};
  SmallRaster tiles = strips;
  tiles.creation_options = {"TILED=YES", "BLOCKXSIZE=512", "BLOCKYSIZE=512"};
  EXPECT_EQ(scan(folder.write("a.tif", strips)).fingerprint,
            scan(folder.write("b.tif", tiles)).fingerprint);
}

TEST(FingerprintOfADem, ChangesWithOneHeightThePlaceAndTheCrs) {
  const RasterFolder folder;
  SmallRaster raster = with_samples(100, 1);
  raster.geotransform = north_up(500000, 4000000, 10);
  raster.crs = "EPSG:32610";
  const std::string file = folder.write("a.tif", raster);
  const std::string fingerprint = scan(file).fingerprint;
  EXPECT_EQ(scan(file).fingerprint, fingerprint);
  EXPECT_NE(scan(file, {.crs = "EPSG:32611"}).fingerprint, fingerprint);
  EXPECT_NE(scan(file, {.vertical_unit = VerticalUnit::kFoot}).fingerprint, fingerprint);
  raster.geotransform = north_up(500000, 4000001, 10);
  EXPECT_NE(scan(folder.write("b.tif", raster)).fingerprint, fingerprint);
  raster = with_samples(101, 1);
  raster.geotransform = north_up(500000, 4000000, 10);
  raster.crs = "EPSG:32610";
  EXPECT_NE(scan(folder.write("c.tif", raster)).fingerprint, fingerprint);
}

}  // namespace
}  // namespace terrane::ingest

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "core/errors.h"
#include "ingest/dem.h"
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
using testing::read_all;
using testing::SmallRaster;

std::string error_of(const std::string& source, const OpenOptions& options = {}) {
  return input_error_of([&] { open_quietly(source, options); });
}

TEST(OpenDem, AMissingFileIsNamed) {
  EXPECT_THAT(error_of("/nowhere/hill.tif"),
              AllOf(HasSubstr("/nowhere/hill.tif: no such file"), Not(HasSubstr("\n"))));
}

TEST(OpenDem, ATextFileIsNoRaster) {
  const RasterFolder folder;
  EXPECT_THAT(error_of(folder.write_text("notes.tif", "not a raster")),
              HasSubstr("notes.tif: not a raster"));
}

TEST(OpenDem, AnEmptyFileIsNoRaster) {
  const RasterFolder folder;
  EXPECT_THAT(error_of(folder.write_text("empty.tif", "")), HasSubstr("empty.tif: not a raster"));
}

TEST(OpenDem, ARasterWithoutSamplesIsRefusedWithItsSize) {
  const RasterFolder folder;
  const std::string file = folder.write_text(
      "empty.vrt",
      "<VRTDataset rasterXSize='0' rasterYSize='0'><VRTRasterBand dataType='Byte' band='1'/>"
      "</VRTDataset>");
  EXPECT_THAT(error_of(file), AllOf(HasSubstr("empty.vrt"), HasSubstr("0 x 0")));
}

TEST(OpenDem, ALineOfSamplesIsNoTerrain) {
  const RasterFolder folder;
  EXPECT_THAT(error_of(folder.write("column.tif", {.columns = 1, .rows = 9})),
              AllOf(HasSubstr("column.tif: has 1 x 9 samples"), HasSubstr("at least 2 x 2")));
  EXPECT_THAT(error_of(folder.write("row.tif", {.columns = 9, .rows = 1})),
              HasSubstr("row.tif: has 9 x 1 samples"));
}

TEST(OpenDem, TwoByTwoSamplesAreEnough) {
  const RasterFolder folder;
  const auto dem = open_quietly(folder.write("least.tif", {.columns = 2, .rows = 2}));
  EXPECT_EQ(dem->heights().shape(), (GridShape{2, 2}));
}

TEST(OpenDem, ComplexNumbersAreNoHeights) {
  const RasterFolder folder;
  EXPECT_THAT(
      error_of(folder.write("radar.tif", {.type = "CFloat32"})),
      AllOf(HasSubstr("radar.tif: band 1 holds complex numbers (CFloat32)"), HasSubstr("--band")));
}

TEST(OpenDem, AnUnknownCrsIsNamed) {
  const RasterFolder folder;
  const std::string file = folder.write("a.tif", {.geotransform = north_up(0, 0, 1)});
  EXPECT_THAT(error_of(file, {.crs = "EPSG:999999"}),
              AllOf(HasSubstr("a.tif: the CRS 'EPSG:999999' is not known"), HasSubstr("--crs")));
}

TEST(OpenDem, AnUnreadableNodataIsASettingToChange) {
  const RasterFolder folder;
  const std::string file = folder.write("a.tif", {});
  EXPECT_THROW(open_quietly(file, {.nodata = "void"}), ConfigError);
}

TEST(OpenDem, AContainerNamesItsRasters) {
  const RasterFolder folder;
  const std::string part = folder.write("part.tif", {.columns = 300,
                                                     .rows = 300,
                                                     .type = "Byte",
                                                     .value = [](int c, int) { return c % 200; },
                                                     .geotransform = north_up(0, 0, 10),
                                                     .crs = "EPSG:32610"});
  const std::string file = folder.path_of("box.gpkg");
  testing::convert(part, file, {"-of", "GPKG", "-co", "RASTER_TABLE=heights"});
  testing::convert(part, file,
                   {"-of", "GPKG", "-co", "RASTER_TABLE=depths", "-co", "APPEND_SUBDATASET=YES"});
  EXPECT_THAT(error_of(file), AllOf(HasSubstr("box.gpkg: holds 2 rasters"),
                                    HasSubstr("e.g. GPKG:" + file + ":heights")));
}

TEST(OpenDem, WithoutASourceSaysWhatIsMissing) {
  NoProgress progress;
  EXPECT_THAT(input_error_of([&] { open_dem({}, {}, progress); }), HasSubstr("no DEM is given"));
}

TEST(OpenDem, IsNamedAfterTheFileWithoutFolders) {
  const RasterFolder folder;
  EXPECT_EQ(open_quietly(folder.write("hill.tif", {}))->name(), "hill.tif");
}

TEST(OpenDem, LeavesNothingBesideTheFile) {
  const RasterFolder folder;
  read_all(*open_quietly(folder.write("hill.tif", {})));
  const auto files = std::filesystem::directory_iterator(folder.path_of(""));
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST(VerticalUnitOfADem, IsTheBandsUnlessTheUserKnowsBetter) {
  const RasterFolder folder;
  const std::string file = folder.write("a.tif", {.unit = "ft"});
  EXPECT_EQ(read_all(*open_quietly(file)).at(2, 2), static_cast<float>(10 * 0.3048));
  EXPECT_EQ(open_quietly(file)->description().vertical_unit_origin, "the band");

  const OpenOptions metres = {.vertical_unit = VerticalUnit::kMetre};
  EXPECT_EQ(read_all(*open_quietly(file, metres)).at(2, 2), 10.0F);
  EXPECT_EQ(open_quietly(file, metres)->description().vertical_unit_origin, "--vertical-unit");
}

TEST(VerticalUnitOfADem, ComesFromTheCompoundCrsWhereTheBandIsSilent) {
  const RasterFolder folder;
  const std::string file = folder.write("a.tif", {.geotransform = north_up(-120, 40, 0.01)});
  // EPSG:6360: NAVD88 height in US survey feet
  const auto dem = open_quietly(file, {.crs = "EPSG:4269+6360"});
  EXPECT_EQ(dem->description().vertical_unit, VerticalUnit::kUsSurveyFoot);
  EXPECT_EQ(dem->description().vertical_unit_origin, "the CRS");
  EXPECT_EQ(read_all(*dem).at(2, 2), static_cast<float>(10 * (1200.0 / 3937.0)));
  EXPECT_THAT(dem->place().crs_wkt(), Not(HasSubstr("VERT")));
}

TEST(VerticalUnitOfADem, ComesFromTheCrsOfTheFileToo) {
  const RasterFolder folder;
  // EPSG:8228: NAVD88 height in feet
  const std::string file = folder.write("a.tif", {.geotransform = north_up(-120, 40, 0.01),
                                                  .crs = "EPSG:4269+8228",
                                                  .creation_options = {"GEOTIFF_VERSION=1.1"}});
  EXPECT_EQ(open_quietly(file)->description().vertical_unit, VerticalUnit::kFoot);
}

TEST(VerticalUnitOfADem, IsAskedForWhereTheBandsWordIsUnknown) {
  const RasterFolder folder;
  const std::string file = folder.write("a.tif", {.unit = "fathom"});
  EXPECT_THAT(error_of(file),
              AllOf(HasSubstr("a.tif: cannot tell the unit of heights from 'fathom'"),
                    HasSubstr("--vertical-unit metre, foot or us-survey-foot")));
  EXPECT_EQ(error_of(file, {.vertical_unit = VerticalUnit::kFoot}), "no error");
}

TEST(VerticalUnitOfADem, IsMetreWhereNothingIsSaid) {
  const RasterFolder folder;
  const auto dem = open_quietly(folder.write("a.tif", {}));
  EXPECT_EQ(read_all(*dem).at(2, 2), 10.0F);
  EXPECT_THAT(dem->description().vertical_unit_origin, HasSubstr("metre is assumed"));
}

}  // namespace
}  // namespace terrane::ingest

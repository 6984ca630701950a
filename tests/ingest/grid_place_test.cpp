#include "ingest/grid_place.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.h"
#include "small_raster.h"

namespace terrane::ingest {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::input_error_of;
using ::testing::IsEmpty;
using testing::north_up;
using testing::open_quietly;
using testing::RasterFolder;
using testing::RecordingProgress;
using testing::SmallRaster;

struct Opened {
  std::unique_ptr<Dem> dem;
  std::vector<std::string> notes;
};

Opened open_noting(const std::string& file, const OpenOptions& options = {}) {
  RecordingProgress progress;
  auto dem = open_dem({file}, options, progress);
  return {std::move(dem), progress.notes()};
}

LonLat lon_lat(const Dem& dem, GridPosition position) {
  return dem.place().to_lon_lat(std::span(&position, 1)).front();
}

TEST(GridPlace, PutsSamplesIntoTheMiddleOfTheirCells) {
  const RasterFolder folder;
  const auto dem = open_quietly(
      folder.write("a.tif", {.geotransform = north_up(500000, 4000000, 10), .crs = "EPSG:32610"}));
  const PlanPosition first = dem->place().to_plan({0, 0});
  EXPECT_EQ(first.x, 500005);
  EXPECT_EQ(first.y, 3999995);
  EXPECT_EQ(dem->description().column_spacing, 10);
}

TEST(GridPlace, TreatsPointRastersLikeAreaOnes) {
  const RasterFolder folder;
  const SmallRaster area = {.geotransform = north_up(-122, 43, 0.5), .crs = "EPSG:4326"};
  const std::string file = folder.write("area.tif", area);
  // GDAL stores the tie point of the same grid differently and says the same when it opens it
  const std::string point = folder.path_of("point.tif");
  testing::convert(file, point, {"-mo", "AREA_OR_POINT=Point"});
  EXPECT_EQ(open_quietly(point)->place().to_plan({0, 0}).x, -121.75);
  EXPECT_EQ(open_quietly(file)->place().to_plan({0, 0}).x, -121.75);
}

TEST(GridPlace, FollowsRotatedStretchedAndSouthUpGrids) {
  const RasterFolder folder;
  const auto dem = open_quietly(folder.write(
      "a.tif",
      {.geotransform = std::array<double, 6>{500000, 3, 8, 4000000, 4, 6}, .crs = "EPSG:32610"}));
  const PlanPosition place = dem->place().to_plan({1.5, 0.5});
  EXPECT_EQ(place.x, 500000 + 3 * 2 + 8 * 1);
  EXPECT_EQ(place.y, 4000000 + 4 * 2 + 6 * 1);
  EXPECT_EQ(dem->description().column_spacing, 5);
  EXPECT_EQ(dem->description().row_spacing, 10);
}

TEST(GridPlace, RefusesCellsWithoutArea) {
  const RasterFolder folder;
  const std::string file = folder.write_text(
      "flat.vrt",
      "<VRTDataset rasterXSize='4' rasterYSize='3'><GeoTransform>0, 1, 2, 0, 2, 4</GeoTransform>"
      "<VRTRasterBand dataType='Byte' band='1'/></VRTDataset>");
  EXPECT_THAT(
      input_error_of([&] { open_quietly(file); }),
      AllOf(HasSubstr("flat.vrt: its geotransform (0, 1, 2, 0, 2, 4)"), HasSubstr("gdal_edit")));
}

TEST(GridPlace, WithoutGeotransformUsesOneMetreCellsAndSaysSo) {
  const RasterFolder folder;
  const auto [dem, notes] = open_noting(folder.write("a.tif", {}));
  EXPECT_THAT(notes,
              ElementsAre(AllOf(HasSubstr("a.tif: has no geotransform"), HasSubstr("1 x 1 m"))));
  const PlanPosition first = dem->place().to_plan({0, 0});
  const PlanPosition next = dem->place().to_plan({1, 1});
  EXPECT_EQ(next.x - first.x, 1);
  EXPECT_EQ(next.y - first.y, -1);  // rows go to the south
  EXPECT_EQ(dem->place().crs_wkt(), "");
}

TEST(GridPlace, WithoutGeotransformRefusesACrs) {
  const RasterFolder folder;
  const std::string file = folder.write("a.tif", {});
  EXPECT_THAT(input_error_of([&] { open_quietly(file, {.crs = "EPSG:4326"}); }),
              HasSubstr("a.tif: has no geotransform, so --crs EPSG:4326 cannot place it"));
}

TEST(GridPlace, WithoutCrsTakesLocalMetresAndSaysSo) {
  const RasterFolder folder;
  const auto [dem, notes] =
      open_noting(folder.write("a.tif", {.geotransform = north_up(500000, 4000000, 10)}));
  EXPECT_THAT(notes, ElementsAre(AllOf(HasSubstr("a.tif: says no CRS"), HasSubstr("local metres"),
                                       HasSubstr("--crs"))));
  EXPECT_EQ(dem->place().crs_wkt(), "");
  EXPECT_EQ(dem->place().to_plan({0, 0}).x, 500005);
}

TEST(GridPlace, WithoutCrsRecognisesDegrees) {
  const RasterFolder folder;
  const auto opened =
      open_noting(folder.write("a.tif", {.geotransform = north_up(-106, 38, 1.0 / 1200)}));
  EXPECT_THAT(opened.notes, ElementsAre(HasSubstr("--crs EPSG:4326")));
}

TEST(GridPlace, TakesAnEngineeringCrsForLocalAndKeepsItsUnit) {
  const RasterFolder folder;
  const std::string file = folder.write_text(
      "site.vrt",
      "<VRTDataset rasterXSize='4' rasterYSize='3'>"
      "<SRS>LOCAL_CS[\"Site\",UNIT[\"foot\",0.3048],AXIS[\"E\",EAST],AXIS[\"N\",NORTH]]</SRS>"
      "<GeoTransform>1000, 100, 0, 2000, 0, -100</GeoTransform>"
      "<VRTRasterBand dataType='Byte' band='1'/></VRTDataset>");
  const auto [dem, notes] = open_noting(file);
  EXPECT_THAT(notes, ElementsAre(HasSubstr("site.vrt: its CRS gives it no place on Earth")));
  EXPECT_EQ(dem->place().crs_wkt(), "");
  EXPECT_DOUBLE_EQ(dem->place().to_plan({0, 0}).x, 1050 * 0.3048);
  EXPECT_DOUBLE_EQ(dem->description().column_spacing, 30.48);
}

TEST(GridPlace, OfAGeographicCrsIsItself) {
  const RasterFolder folder;
  const auto [dem, notes] = open_noting(
      folder.write("a.tif", {.geotransform = north_up(-123, 43, 0.5), .crs = "EPSG:4326"}));
  EXPECT_THAT(notes, IsEmpty());
  const LonLat place = lon_lat(*dem, {1, 0});
  EXPECT_EQ(place.longitude_deg, -122.25);
  EXPECT_EQ(place.latitude_deg, 42.75);
  EXPECT_EQ(dem->description().crs_unit, "degree");
}

TEST(GridPlace, CountsLongitudesBeyond180BackFromTheDateLine) {
  const RasterFolder folder;
  const auto dem = open_quietly(folder.write(
      "pacific.tif", {.columns = 40, .geotransform = north_up(170, -40, 0.5), .crs = "EPSG:4326"}));
  EXPECT_EQ(lon_lat(*dem, {0, 0}).longitude_deg, 170.25);
  EXPECT_EQ(lon_lat(*dem, {39, 0}).longitude_deg, -170.25);
}

TEST(GridPlace, HoldsTheWholeEarthCountedFrom0To360) {
  const RasterFolder folder;
  // sample centres from 0 E to 359 E and from pole to pole
  const auto dem = open_quietly(folder.write(
      "earth.tif",
      {.columns = 360, .rows = 181, .geotransform = north_up(-0.5, 90.5, 1), .crs = "EPSG:4326"}));
  EXPECT_EQ(lon_lat(*dem, {0, 0}).latitude_deg, 90);
  EXPECT_EQ(lon_lat(*dem, {200, 180}).latitude_deg, -90);
  EXPECT_EQ(lon_lat(*dem, {200, 90}).longitude_deg, -160);
}

TEST(GridPlace, DropsTheHeightOfAThreeDimensionalCrs) {
  const RasterFolder folder;
  const std::string file = folder.write("a.tif", {.geotransform = north_up(-123, 43, 0.5)});
  const auto dem = open_quietly(file, {.crs = "EPSG:4979"});
  EXPECT_EQ(lon_lat(*dem, {1, 0}).longitude_deg, -122.25);
  EXPECT_THAT(dem->place().crs_wkt(), ::testing::Not(HasSubstr("ellipsoidal height")));
}

TEST(GridPlace, RefusesMetresAsDegrees) {
  const RasterFolder folder;
  const std::string file = folder.write("a.tif", {.geotransform = north_up(500000, 4000000, 10)});
  EXPECT_THAT(input_error_of([&] { open_quietly(file, {.crs = "EPSG:4326"}); }),
              AllOf(HasSubstr("a.tif: the CRS EPSG:4326 cannot place it"), HasSubstr("--crs")));
}

TEST(GridPlace, TheUsersCrsWinsOverTheFiles) {
  const RasterFolder folder;
  const std::string file =
      folder.write("a.tif", {.geotransform = north_up(500000, 0, 10), .crs = "EPSG:32610"});
  EXPECT_NEAR(lon_lat(*open_quietly(file), {-0.5, -0.5}).longitude_deg, -123, 1e-12);
  EXPECT_NEAR(lon_lat(*open_quietly(file, {.crs = "EPSG:32611"}), {-0.5, -0.5}).longitude_deg, -117,
              1e-12);
}

TEST(GridPlace, NamesAPositionThatHasNoLongitude) {
  const RasterFolder folder;
  // an orthographic view of the Earth: the corners of its square see past it
  const std::string file = folder.write("globe.tif", {.columns = 14,
                                                      .rows = 14,
                                                      .geotransform = north_up(-7e6, 7e6, 1e6),
                                                      .crs = "+proj=ortho +lat_0=0 +lon_0=0"});
  const auto dem = open_quietly(file);
  EXPECT_NEAR(lon_lat(*dem, {6.5, 6.5}).longitude_deg, 0, 1e-9);
  EXPECT_THAT(input_error_of([&] {
                lon_lat(*dem, {0, 0});
              }),
              HasSubstr("globe.tif: column 0, row 0 has no longitude and latitude"));
}

TEST(GridPlace, SaysSoWhereTheDatumIsUnknown) {
  const RasterFolder folder;
  const auto opened =
      open_noting(folder.write("a.tif", {.geotransform = north_up(10, 40, 0.5),
                                         .crs = "+proj=longlat +a=6378000 +rf=298 +no_defs"}));
  EXPECT_THAT(opened.notes, ElementsAre(HasSubstr("no datum shift")));
}

}  // namespace
}  // namespace terrane::ingest

#include "ingest/features.h"

#include <gmock/gmock.h>

#include <cmath>

#include "small_raster.h"

namespace terrane::ingest {
namespace {

using testing::north_up;
using testing::open_quietly;
using testing::RasterFolder;
using testing::RecordingProgress;
using testing::SmallRaster;

/// Straight lines of 20 x 20 samples at 100 m in UTM zone 32, (0, 0) at easting 500,050, northing
/// 5,101,950.
SmallRaster utm_raster() {
  return {.columns = 20,
          .rows = 20,
          .value = [](int column, int row) { return 100 + column + row; },
          .geotransform = north_up(500000, 5102000, 100),
          .crs = "EPSG:32632"};
}

std::string geojson(const std::string& type, const std::string& coordinates,
                    const std::string& crs) {
  return R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":")" + crs +
         R"("}},"features":[{"type":"Feature","properties":{},"geometry":{"type":")" + type +
         R"(","coordinates":)" + coordinates + "}}]}";
}

GridFeatures features_of(Dem& dem, const FeatureOptions& options) {
  RecordingProgress progress;
  return read_features(dem, options, progress);
}

TEST(ReadFeatures, TakesALayerInTheDemsOwnCrsByTheAffineMapAlone) {
  const RasterFolder folder;
  const auto dem = open_quietly(folder.write("dem.tif", utm_raster()));
  const std::string lines = folder.write_text(
      "l.geojson",
      geojson("LineString", "[[500150,5101850],[500350,5101850]]", "urn:ogc:def:crs:EPSG::32632"));
  const GridFeatures features = features_of(*dem, {.lines = {lines}});
  ASSERT_EQ(features.lines.size(), 1U);
  const auto& points = features.lines[0].points;
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points[0].column, 1);
  EXPECT_EQ(points[0].row, 1);
  EXPECT_EQ(points[2].column, 3);
  EXPECT_NEAR(features.column_m, 100, 0.1);  // UTM's scale on its middle meridian is 0.9996
}

TEST(ReadFeatures, ReprojectsLongitudesToWhereTheDemsOwnMapHasThem) {
  const RasterFolder folder;
  const auto dem = open_quietly(folder.write("dem.tif", utm_raster()));
  const std::vector<GridPosition> wanted{{2.25, 3.5}, {15.5, 11.25}};
  const std::vector<LonLat> at = dem->place().to_lon_lat(wanted);
  const std::string lines =
      folder.write_text("l.geojson", geojson("LineString",
                                             "[[" + std::to_string(at[0].longitude_deg) + "," +
                                                 std::to_string(at[0].latitude_deg) + "],[" +
                                                 std::to_string(at[1].longitude_deg) + "," +
                                                 std::to_string(at[1].latitude_deg) + "]]",
                                             "urn:ogc:def:crs:OGC:1.3:CRS84"));
  const GridFeatures features = features_of(*dem, {.lines = {lines}});
  ASSERT_EQ(features.lines.size(), 1U);
  // six decimals of a degree are 0.06 m, and points move by 1/256 cell at most
  EXPECT_NEAR(features.lines[0].points.front().column, 2.25, 0.006);
  EXPECT_NEAR(features.lines[0].points.front().row, 3.5, 0.006);
  EXPECT_NEAR(features.lines[0].points.back().column, 15.5, 0.006);
  EXPECT_NEAR(features.lines[0].points.back().row, 11.25, 0.006);
}

TEST(ReadFeatures, WaterIsFlatInTheDemAndItsShoresAreLinesOfThatHeight) {
  const RasterFolder folder;
  const auto dem = open_quietly(folder.write("dem.tif", utm_raster()));
  const std::string water = folder.write_text(
      "w.geojson", geojson("Polygon",
                           "[[[500300,5101700],[500900,5101700],[500900,5101100],[500300,5101100],"
                           "[500300,5101700]]]",
                           "urn:ogc:def:crs:EPSG::32632"));
  const GridFeatures features =
      features_of(*dem, {.water = {water}, .water_height_m = 42, .plan_tolerance_m = 5});
  ASSERT_EQ(features.lines.size(), 1U);
  EXPECT_EQ(features.lines[0].height_m, 42);
  EXPECT_LE(features.off_plan_m, 0.5 * 5);
  const HeightGrid heights = testing::read_all(*dem);
  // columns and rows 3 to 8: their centres are inside
  EXPECT_EQ(heights.at(3, 3), 42);
  EXPECT_EQ(heights.at(8, 8), 42);
  EXPECT_EQ(heights.at(2, 5), 107);
  EXPECT_EQ(heights.at(9, 5), 114);
}

TEST(ReadFeatures, CutsOffWhatLiesBesideTheDem) {
  const RasterFolder folder;
  const auto dem = open_quietly(folder.write("dem.tif", utm_raster()));
  const std::string lines = folder.write_text(
      "l.geojson",
      geojson("LineString", "[[400000,5101850],[600000,5101850]]", "urn:ogc:def:crs:EPSG::32632"));
  const GridFeatures features = features_of(*dem, {.lines = {lines}});
  ASSERT_EQ(features.lines.size(), 1U);
  EXPECT_LT(features.lines[0].points.size(), 30U);
}

}  // namespace
}  // namespace terrane::ingest

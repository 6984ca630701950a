// Real DEMs. Counts and extremes are those of `gdalinfo -stats` (GDAL's own pass over the file,
// through its own masks) and of the files' documentation.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "core/errors.h"
#include "ingest/dem.h"
#include "ingest/scan.h"
#include "small_raster.h"

namespace terrane::ingest {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::input_error_of;
using ::testing::IsEmpty;
using testing::open_quietly;
using testing::real_dem;
using testing::RecordingProgress;

constexpr double kFoot_m = 0.3048;

HeightStatistics scan(const Dem& dem) {
  NoProgress progress;
  return scan_heights(dem, progress);
}

void expect_range(const HeightStatistics& statistics, double min_m, double max_m) {
  EXPECT_EQ(statistics.min_height_m, min_m);
  EXPECT_EQ(statistics.max_height_m, max_m);
}

TEST(RealDem, StHelensHasItsPeakAndItsSlantedRim) {
  const std::string file = real_dem("st_helens/SainteHelens_post1980_30m.dem");
  TERRANE_SKIP_WITHOUT(file);
  const auto dem = open_quietly(file);
  EXPECT_EQ(dem->heights().shape(), (GridShape{327, 468}));
  EXPECT_EQ(dem->description().vertical_unit_origin, "the band");
  const HeightStatistics statistics = scan(*dem);
  expect_range(statistics, 682, 2543);
  EXPECT_EQ(statistics.samples_with_data, 148885);  // 97.29 % of 153,036
  const HeightGrid corners = dem->heights().read({0, 0, 327, 468});
  EXPECT_FALSE(corners.has_data(0, 0));
  EXPECT_TRUE(corners.has_data(163, 234));
}

TEST(RealDem, StHelensIn10mComesOutInMetres) {
  const std::string file = real_dem("st_helens/mtsthelens_after1980_10m_feet.dem");
  TERRANE_SKIP_WITHOUT(file);
  const auto dem = open_quietly(file);
  EXPECT_EQ(dem->description().vertical_unit, VerticalUnit::kFoot);
  const HeightStatistics statistics = scan(*dem);
  // the file's samples run from 2231 to 8367 feet
  expect_range(statistics, static_cast<double>(static_cast<float>(2231 * kFoot_m)),
               static_cast<double>(static_cast<float>(8367 * kFoot_m)));
  EXPECT_NEAR(static_cast<double>(statistics.samples_with_data) / (979 * 1400), 0.9776, 0.00005);
}

TEST(RealDem, BandsOfATwoBandDemAreBeforeAndAfter) {
  const std::string file = real_dem("st_helens/before_after_2band.vrt");
  TERRANE_SKIP_WITHOUT(file);
  EXPECT_THAT(input_error_of([&] { open_quietly(file); }),
              HasSubstr("has 2 bands; pick the one with the heights with --band N (1 to 2)"));
  expect_range(scan(*open_quietly(file, {.band = 1})), 676, 2951);
  expect_range(scan(*open_quietly(file, {.band = 2})), 682, 2543);
}

TEST(RealDem, SrtmVoidsAreNoHeights) {
  const std::string file = real_dem("crater_lake/N42W123.hgt");
  TERRANE_SKIP_WITHOUT(file);
  const auto dem = open_quietly(file);
  const HeightStatistics statistics = scan(*dem);
  EXPECT_EQ(statistics.samples_with_data, 1201 * 1201 - 186);
  expect_range(statistics, 290, 2858);
  // by its name the file's corner samples lie on whole degrees
  const std::vector<GridPosition> corners = {{0, 0}, {1200, 1200}};
  const auto places = dem->place().to_lon_lat(corners);
  EXPECT_NEAR(places[0].longitude_deg, -123, 1e-12);
  EXPECT_NEAR(places[0].latitude_deg, 43, 1e-12);
  EXPECT_NEAR(places[1].longitude_deg, -122, 1e-12);
  EXPECT_NEAR(places[1].latitude_deg, 42, 1e-12);
}

TEST(RealDem, CapeTownsSeaIsNoData) {
  const std::string file = real_dem("awkward/cape_town_srtm_sea_nodata.tif");
  TERRANE_SKIP_WITHOUT(file);
  const HeightStatistics statistics = scan(*open_quietly(file));
  expect_range(statistics, -28, 1077);
  EXPECT_NEAR(static_cast<double>(statistics.samples_with_data) / (723 * 1105), 0.6099, 0.00005);
}

TEST(RealDem, AlpsHaveTheirVoids) {
  const std::string file = real_dem("awkward/N46E008.tif");
  TERRANE_SKIP_WITHOUT(file);
  const HeightStatistics statistics = scan(*open_quietly(file));
  expect_range(statistics, 187, 4173);
  EXPECT_NEAR(static_cast<double>(statistics.samples_with_data) / (1201 * 1201), 0.9281, 0.00005);
}

TEST(RealDem, NewZealandsNanIsNoData) {
  const std::string file = real_dem("awkward/nz_elev_nan_nodata.tif");
  TERRANE_SKIP_WITHOUT(file);
  RecordingProgress progress;
  const auto dem = open_dem({file}, {}, progress);
  EXPECT_THAT(progress.notes(), IsEmpty());
  const HeightStatistics statistics = scan(*dem);
  EXPECT_NEAR(1 - static_cast<double>(statistics.samples_with_data) / (1115 * 1450), 0.83, 0.005);
  EXPECT_NEAR(statistics.max_height_m, 4140.333, 0.0005);
  // gdalinfo's upper left corner: 166d26'26.04"E, 34d14'15.92"S; half a cell north-west of sample 0
  const GridPosition corner{-0.5, -0.5};
  const LonLat place = dem->place().to_lon_lat({&corner, 1}).front();
  EXPECT_NEAR(place.longitude_deg, 166 + 26 / 60.0 + 26.04 / 3600, 0.006 / 3600);
  EXPECT_NEAR(place.latitude_deg, -34 - 14 / 60.0 - 15.92 / 3600, 0.006 / 3600);
}

TEST(RealDem, TwoFilesMakeTheMosaicThatTheirVrtDescribes) {
  const std::string west = real_dem("awkward/N49W124.tif");
  const std::string east = real_dem("awkward/N49W123.tif");
  TERRANE_SKIP_WITHOUT(west);
  NoProgress progress;
  const auto dem = open_dem({west, east}, {}, progress);
  EXPECT_EQ(dem->heights().shape(), (GridShape{2401, 1201}));
  const HeightStatistics statistics = scan(*dem);
  expect_range(statistics, -37, 2674);
  EXPECT_NEAR(static_cast<double>(statistics.samples_with_data) / (2401 * 1201), 0.979, 0.0005);
  const auto by_gdal = open_quietly(real_dem("awkward/vancouver_N49W124_N49W123.vrt"));
  EXPECT_EQ(scan(*by_gdal).samples_with_data, statistics.samples_with_data);
  const Window seam{1100, 300, 200, 400};
  EXPECT_THAT(dem->heights().read(seam).heights_m,
              ::testing::Pointwise(::testing::NanSensitiveFloatEq(),
                                   by_gdal->heights().read(seam).heights_m));
}

TEST(RealDem, AnImageOfCraterLakeIsRefused) {
  const std::string file = real_dem("crater_lake/craterlake-imagery-30m.tif");
  TERRANE_SKIP_WITHOUT(file);
  EXPECT_THAT(input_error_of([&] { open_quietly(file); }),
              AllOf(HasSubstr("craterlake-imagery-30m.tif: has 4 bands"),
                    HasSubstr("looks like an image"), HasSubstr("--band N (1 to 4)")));
}

TEST(RealDem, UndeclaredNodataOfTheLakeFloorIsReported) {
  const std::string file = real_dem("crater_lake/craterlake-bathymetry-elev-16bit-30m.tif");
  TERRANE_SKIP_WITHOUT(file);
  EXPECT_THAT(input_error_of([&] { scan(*open_quietly(file)); }),
              AllOf(HasSubstr("samples hold -32767"), HasSubstr("Use --nodata -32767")));
  const HeightStatistics told = scan(*open_quietly(file, {.nodata = "-32767"}));
  expect_range(told, 1289, 1880);
  const auto declared = open_quietly(real_dem("crater_lake/craterlake-bathymetry_nodata.vrt"));
  EXPECT_EQ(scan(*declared).fingerprint, told.fingerprint);
}

TEST(RealDem, ARotatedGridHasTheHeightsOfItsSourceElsewhere) {
  const std::string file = real_dem("awkward/rotated30_garland_ARTIFICIAL.vrt");
  TERRANE_SKIP_WITHOUT(file);
  const auto rotated = open_quietly(file);
  const auto upright = open_quietly(real_dem("crater_lake/crater_garland_nad27_utm10.tif"));
  const Window window{100, 100, 50, 50};
  EXPECT_EQ(rotated->heights().read(window).heights_m, upright->heights().read(window).heights_m);
  // 30 degrees: one column on is cos 30 * 30 m east and sin 30 * 30 m north
  const PlanPosition a = rotated->place().to_plan({0, 0});
  const PlanPosition b = rotated->place().to_plan({1, 0});
  EXPECT_NEAR(b.x - a.x, 25.980762, 1e-6);
  EXPECT_NEAR(b.y - a.y, 15, 1e-9);
}

TEST(RealDem, TheGreatScottishMosaicIsHalfSea) {
  const std::string file = real_dem("large/os50_squareN_f32.vrt");
  TERRANE_SKIP_WITHOUT(file);
  const auto dem = open_quietly(file);
  // Ben Nevis, NN 166 712: column (216600 - 25) / 50, row (1000000 - 771200) / 50
  const HeightGrid ben_nevis = dem->heights().read({4327, 4571, 10, 10});
  const float top_m = *std::max_element(ben_nevis.heights_m.begin(), ben_nevis.heights_m.end());
  EXPECT_NEAR(top_m, 1345, 20);
}

TEST(RealDem, TrinidadOpensFromNetcdfInFeet) {
  const std::string path = "/usr/share/ncarg/data/cdf/trinidad.nc";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "Debian's libncarg-data is absent";
  const std::string source = "NETCDF:" + path + ":data";
  RecordingProgress progress;
  const auto silent = open_dem({source}, {}, progress);
  EXPECT_THAT(progress.notes(), ElementsAre(HasSubstr("--crs EPSG:4326")));
  EXPECT_EQ(silent->description().vertical_unit, VerticalUnit::kMetre);  // the file says nothing

  const auto dem = open_quietly(source, {.vertical_unit = VerticalUnit::kFoot, .crs = "EPSG:4326"});
  EXPECT_EQ(dem->heights().shape(), (GridShape{2401, 1201}));
  const HeightStatistics statistics = scan(*dem);
  EXPECT_EQ(statistics.samples_with_data, 2401 * 1201);
  // 4457.52 to 14176.16 feet
  EXPECT_NEAR(statistics.min_height_m, 1358.652, 0.001);
  EXPECT_NEAR(statistics.max_height_m, 4320.894, 0.001);
  const std::vector<GridPosition> corners = {{0, 0}, {2400, 1200}};
  const auto places = dem->place().to_lon_lat(corners);
  EXPECT_NEAR(places[0].longitude_deg, -106, 1e-7);
  EXPECT_NEAR(places[1].latitude_deg, 37, 1e-7);
}

}  // namespace
}  // namespace terrane::ingest

#include "ingest/datum_shift.h"

#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <thread>

namespace terrane::ingest {
namespace {

constexpr double kMetresPerDegree = 111320;

std::unique_ptr<DatumShift> find_shift(const std::string& crs,
                                       const std::vector<PlanPosition>& at) {
  return DatumShift::find(crs, {1, 2}, at);
}

// latitude first, as EPSG has them: plan x is the second axis
std::unique_ptr<DatumShift> find_geographic_shift(const std::string& crs,
                                                  const std::vector<PlanPosition>& at) {
  return DatumShift::find(crs, {2, 1}, at);
}

double distance_m(LonLat a, LonLat b) {
  const double east_deg =
      (a.longitude_deg - b.longitude_deg) * std::cos(a.latitude_deg * 3.14159265358979323846 / 180);
  return std::hypot(east_deg, a.latitude_deg - b.latitude_deg) * kMetresPerDegree;
}

TEST(DatumShift, IsNothingFromWgs84) {
  const std::vector<PlanPosition> places = {{-122.5, 46.25}, {-122.125, 46.0}};
  const auto result = find_geographic_shift("EPSG:4326", places)->to_lon_lat(places);
  EXPECT_EQ(result[0].longitude_deg, -122.5);
  EXPECT_EQ(result[0].latitude_deg, 46.25);
  EXPECT_EQ(result[1].longitude_deg, -122.125);
}

TEST(DatumShift, PutsTheOriginOfAUtmZoneOnItsMeridian) {
  const std::vector<PlanPosition> origin = {{500000, 0}};
  const LonLat place = find_shift("EPSG:32610", origin)->to_lon_lat(origin).front();
  EXPECT_NEAR(place.longitude_deg, -123, 1e-12);
  EXPECT_NEAR(place.latitude_deg, 0, 1e-12);
}

// Worked example of Ordnance Survey's guide to OSTN02: Caister water tower in both systems.
TEST(DatumShift, FindsCaisterWaterTowerFromTheBritishGrid) {
  const std::vector<PlanPosition> tower = {{651409.792, 313177.448}};
  const LonLat etrs89 = {1 + 42 / 60.0 + 57.8663 / 3600, 52 + 39 / 60.0 + 28.8282 / 3600};
  // the seven-parameter shift that serves without OSTN's grid is good to 5 m, says the guide
  EXPECT_LT(distance_m(find_shift("EPSG:27700", tower)->to_lon_lat(tower).front(), etrs89), 5);
}

// The mean shift of NAD27 in the western United States: DMA TR 8350.2, table B.9: (-8, 159, 175) m.
LonLat by_mean_shift(double longitude_deg, double latitude_deg) {
  const double degree = 3.14159265358979323846 / 180;
  const auto eccentricity2 = [](double inverse_flattening) {
    return (2 - 1 / inverse_flattening) / inverse_flattening;
  };
  const double a = 6378206.4;
  const double e2 = eccentricity2(294.978698214);
  const double phi = latitude_deg * degree;
  const double lambda = longitude_deg * degree;
  const double n = a / std::sqrt(1 - e2 * std::sin(phi) * std::sin(phi));
  const double x = n * std::cos(phi) * std::cos(lambda) - 8;
  const double y = n * std::cos(phi) * std::sin(lambda) + 159;
  const double z = n * (1 - e2) * std::sin(phi) + 175;
  const double wgs_e2 = eccentricity2(298.257223563);
  double latitude = std::atan2(z, std::hypot(x, y));
  for (int i = 0; i < 20; ++i) {
    const double wgs_n = 6378137 / std::sqrt(1 - wgs_e2 * std::sin(latitude) * std::sin(latitude));
    latitude = std::atan2(z + wgs_e2 * wgs_n * std::sin(latitude), std::hypot(x, y));
  }
  return {std::atan2(y, x) / degree, latitude / degree};
}

TEST(DatumShift, MovesNad27AtMountStHelensAsTheMeanShiftDoes) {
  const std::vector<PlanPosition> summit = {{-122.19, 46.19}};
  const LonLat place = find_geographic_shift("EPSG:4267", summit)->to_lon_lat(summit).front();
  // 10 m: with NADCON's grid installed PROJ prefers it, and the mean shift is that far off
  EXPECT_LT(distance_m(place, by_mean_shift(-122.19, 46.19)), 10);
  EXPECT_GT(distance_m(place, {-122.19, 46.19}), 80);
}

TEST(DatumShift, AgreesWithGdalWhereGdalHasOneChoice) {
  OGRSpatialReference nad27;
  OGRSpatialReference wgs84;
  nad27.importFromEPSG(26710);
  wgs84.importFromEPSG(4326);
  wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> by_gdal(
      OGRCreateCoordinateTransformation(&nad27, &wgs84));
  std::vector<PlanPosition> places;
  for (int i = 0; i < 10; ++i) places.push_back({557820.0 + 1000 * i, 5121990.0 - 1500 * i});
  const auto ours = find_shift("EPSG:26710", places)->to_lon_lat(places);
  for (std::size_t i = 0; i < places.size(); ++i) {
    double x = places[i].x;
    double y = places[i].y;
    ASSERT_TRUE(by_gdal->Transform(1, &x, &y));
    EXPECT_LT(distance_m(ours[i], {x, y}), 0.001);
  }
}

// From Mexico to Canada, over the Mississippi: PROJ alone uses at least five operations here.
std::vector<PlanPosition> north_america() {
  std::vector<PlanPosition> places;
  for (int row = 0; row <= 120; ++row) {
    for (int column = 0; column <= 200; ++column) {
      places.push_back({-120 + 0.25 * column, 55 - 0.25 * row});
    }
  }
  return places;
}

TEST(DatumShift, MovesNeighboursAlikeAcrossAContinent) {
  const std::vector<PlanPosition> places = north_america();
  const auto moved = find_geographic_shift("EPSG:4267", places)->to_lon_lat(places);
  const auto shift_deg = [&](std::size_t i) {
    return LonLat{moved[i].longitude_deg - places[i].x, moved[i].latitude_deg - places[i].y};
  };
  double largest_step_m = 0;
  for (std::size_t i = 0; i + 201 < places.size(); ++i) {
    if (i % 201 == 200) continue;
    for (const std::size_t neighbour : {i + 1, i + 201}) {
      const LonLat a = shift_deg(i);
      const LonLat b = shift_deg(neighbour);
      largest_step_m = std::max(largest_step_m, std::hypot(a.longitude_deg - b.longitude_deg,
                                                           a.latitude_deg - b.latitude_deg) *
                                                    kMetresPerDegree);
    }
  }
  // a shift of 240 m that turns with the Earth changes by about 240 m * 0.25 degree, 1 m, in a
  // step; GDAL 3.6's own transformation steps by 23 m here
  EXPECT_LT(largest_step_m, 2.5);
}

TEST(DatumShift, GivesTheSameBitsAloneInBatchesAndInThreads) {
  const std::vector<PlanPosition> places = north_america();
  const auto shift = find_geographic_shift("EPSG:4267", places);
  const auto expected = shift->to_lon_lat(places);
  const auto is_same = [](const LonLat& a, const LonLat& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
  };
  for (std::size_t i = 0; i < places.size(); i += 97) {
    EXPECT_TRUE(is_same(shift->to_lon_lat({&places[i], 1}).front(), expected[i]));
  }
  std::vector<int> differences(8);
  std::vector<std::jthread> threads;
  for (int& count : differences) {
    threads.emplace_back([&] {
      for (std::size_t begin = 0; begin + 500 < places.size(); begin += 500) {
        const auto batch = shift->to_lon_lat({&places[begin], 500});
        for (std::size_t i = 0; i < 500; ++i) count += !is_same(batch[i], expected[begin + i]);
      }
    });
  }
  threads.clear();
  for (const int count : differences) EXPECT_EQ(count, 0);
  const auto again = find_geographic_shift("EPSG:4267", places)->to_lon_lat(places);
  for (std::size_t i = 0; i < places.size(); ++i) EXPECT_TRUE(is_same(again[i], expected[i]));
}

TEST(DatumShift, IsNotFoundForWhatIsNoPlaceOnEarth) {
  EXPECT_EQ(find_geographic_shift("EPSG:4326", {{557820, 5121990}}), nullptr);
  EXPECT_EQ(find_shift("not a CRS", {{0, 0}}), nullptr);
}

TEST(DatumShift, FollowsAxesThatPointSouthAndWest) {
  // EPSG:2048, Hartebeesthoek94 / Lo19: its axes are westing and southing
  const std::vector<PlanPosition> origin = {{0, 0}};
  const LonLat place = DatumShift::find("EPSG:2048", {1, 2}, origin)->to_lon_lat(origin).front();
  EXPECT_NEAR(place.longitude_deg, 19, 1e-9);
  const std::vector<PlanPosition> cape_town = {{52000, -3755000}};  // x to the east, y to the north
  const LonLat there =
      DatumShift::find("EPSG:2048", {-1, -2}, cape_town)->to_lon_lat(cape_town).front();
  EXPECT_GT(there.longitude_deg, 19);
  EXPECT_NEAR(there.latitude_deg, -33.92, 0.05);
}

}  // namespace
}  // namespace terrane::ingest

#include "tiler/tile/plan_map.h"

#include <gtest/gtest.h>

#include <GeographicLib/TransverseMercator.hpp>

#include "tests/tiler/test_dem.h"

namespace terrane::tiler {
namespace {

using testing::GeographicPlace;

/// A rotated grid in zone 10 of UTM, by GeographicLib's exact series.
class UtmPlace final : public Georeference {
 public:
  explicit UtmPlace(double cell_m, double central_deg = -123)
      : cell_m_(cell_m), central_deg_(central_deg) {}

  const std::string& crs_wkt() const override { return wkt_; }
  PlanPosition to_plan(GridPosition p) const override {
    return {560000 + cell_m_ * (0.9 * p.column + 0.1 * p.row),
            5120000 + cell_m_ * (0.1 * p.column - 0.9 * p.row)};
  }
  std::vector<LonLat> to_lon_lat(std::span<const GridPosition> positions) const override {
    std::vector<LonLat> result;
    for (const GridPosition& position : positions) {
      const auto [x, y] = to_plan(position);
      LonLat place;
      GeographicLib::TransverseMercator::UTM().Reverse(central_deg_, x - 500000, y,
                                                       place.latitude_deg, place.longitude_deg);
      result.push_back(place);
    }
    return result;
  }

 private:
  std::string wkt_ = "PROJCRS";
  double cell_m_, central_deg_;
};

/// The largest distance of the map from the truth at places that the fit does not have.
double worst_error(const PlanMap& map, const Georeference& place, GridShape shape) {
  double worst = 0;
  for (int k = 0; k < 500; ++k) {
    const GridPosition at{static_cast<double>(shape.columns - 1) * std::fmod(0.618034 * k, 1),
                          static_cast<double>(shape.rows - 1) * std::fmod(0.414214 * k, 1)};
    const PlanPosition found = map.at(place.to_lon_lat({&at, 1}).front());
    const PlanPosition truth = place.to_plan(at);
    worst = std::max(worst, std::hypot(found.x - truth.x, found.y - truth.y));
  }
  return worst;
}

TEST(PlanMap, ComesWithinMillimetresOfTransverseMercatorOverAQuadrangle) {
  const UtmPlace place(30);
  const auto map = fit_plan_map(place, {327, 468});
  ASSERT_TRUE(map);
  EXPECT_LT(map->max_error, 0.003);
  EXPECT_LT(map->degree, 6);
  EXPECT_LT(worst_error(*map, place, {327, 468}), 1.01 * map->max_error);
}

TEST(PlanMap, StatesItsErrorOverFiveHundredKilometres) {
  const UtmPlace place(50);
  const auto map = fit_plan_map(place, {10000, 10000});
  ASSERT_TRUE(map);
  EXPECT_LT(map->max_error, 0.005);
  EXPECT_LT(worst_error(*map, place, {10000, 10000}), 1.01 * map->max_error);
}

TEST(PlanMap, GoesOverTheMeridianOf180Degrees) {
  const UtmPlace place(30, 179.2);
  const auto map = fit_plan_map(place, {500, 500});
  ASSERT_TRUE(map);
  EXPECT_LT(worst_error(*map, place, {500, 500}), 0.003);
}

TEST(PlanMap, IsNotNeededWhereThePlanIsLongitudeAndLatitude) {
  EXPECT_FALSE(fit_plan_map(GeographicPlace({-122.2, 43}, 1.0 / 1200), {429, 279}));
}

}  // namespace
}  // namespace terrane::tiler

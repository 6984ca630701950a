#include "tiler/geodetic/horizon.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace terrane::tiler {
namespace {

constexpr double kEquator_m = 6378137;

TEST(Horizon, AMountainIsItsOwnPoint) {
  const Eigen::Vector3d peak(kEquator_m + 5000, 0, 0);
  const Eigen::Vector3d point = horizon_occlusion_point({&peak, 1}, peak);
  EXPECT_NEAR(point.x(), 1 + 5000 / kEquator_m, 1e-12);
  EXPECT_NEAR(point.y(), 0, 1e-12);
}

TEST(Horizon, ThePointOfTwoPlacesOnTheSurfaceIsWhereTheirTangentsMeet) {
  const double angle = 0.3;  // on each side
  const std::vector<Eigen::Vector3d> places{
      {kEquator_m * std::cos(angle), kEquator_m * std::sin(angle), 0},
      {kEquator_m * std::cos(angle), -kEquator_m * std::sin(angle), 0}};
  const Eigen::Vector3d point = horizon_occlusion_point(places, Eigen::Vector3d::UnitX());
  EXPECT_NEAR(point.x(), 1 / std::cos(angle), 1e-12);
}

TEST(Horizon, WhereNoPointIsRightItIsFarOutAndNeverAtTheCentre) {
  const std::vector<Eigen::Vector3d> hemisphere{
      {0, kEquator_m, 0}, {0, -kEquator_m, 0}, {kEquator_m, 0, 0}};
  const Eigen::Vector3d point = horizon_occlusion_point(hemisphere, Eigen::Vector3d::UnitX());
  EXPECT_GE(point.norm(), 100);
  EXPECT_GT(point.x(), 0);
}

TEST(Horizon, TheSphereHoldsEveryPoint) {
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k < 100; ++k) {
    points.emplace_back(kEquator_m + 37 * std::sin(k), 1000 * std::cos(3.0 * k),
                        900 * std::sin(2.0 * k));
  }
  const Sphere sphere = sphere_around(points);
  for (const Eigen::Vector3d& at : points) EXPECT_LE((at - sphere.centre).norm(), sphere.radius_m);
  EXPECT_LT(sphere.radius_m, 1400);
}

}  // namespace
}  // namespace terrane::tiler

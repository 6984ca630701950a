#include "tiler/tile/oriented_box.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace terrane::tiler {
namespace {

const Axes kTurned = Eigen::AngleAxisd(0.5, Eigen::Vector3d(0, 0, 1)).toRotationMatrix();

TEST(OrientedBox, IsTightAroundARectangleAlongItsAxes) {
  OrientedBox box{.axes = kTurned};
  for (const double x : {-3.0, 3.0}) {
    for (const double y : {-2.0, 2.0}) box.add(Eigen::Vector3d(kTurned * Eigen::Vector3d(x, y, 5)));
  }
  const auto numbers = box.numbers();
  EXPECT_NEAR(numbers[2], 5, 1e-12);
  EXPECT_NEAR(std::hypot(numbers[3], numbers[4]), 3, 1e-12);
  EXPECT_NEAR(std::hypot(numbers[6], numbers[7]), 2, 1e-12);
  EXPECT_NEAR(numbers[11], 0, 1e-12);
  EXPECT_NEAR(box.diagonal_m(), std::hypot(6, 4), 1e-12);
}

TEST(OrientedBox, ContainsTheCornersOfABoxWithOtherAxes) {
  OrientedBox small{.axes = kTurned};
  small.add(Eigen::Vector3d(0, 0, 0));
  small.add(Eigen::Vector3d(4, 1, 2));
  OrientedBox large;
  large.add(small);
  for (const Eigen::Vector3d& along : {small.low, small.high}) {
    const Eigen::Vector3d corner = small.axes * along;
    EXPECT_TRUE((corner.array() >= large.low.array() - 1e-12).all());
    EXPECT_TRUE((corner.array() <= large.high.array() + 1e-12).all());
  }
}

}  // namespace
}  // namespace terrane::tiler

#include "tiler/tile/plane_along_row.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "tests/tiler/test_dem.h"

namespace terrane::tiler {
namespace {

using testing::GeographicPlace;

constexpr std::int64_t kRow = 900, kFirst = 17;

/// A tile of 1,200 cells of 3 arc-seconds: plumb lines and rows bend.
class BentTile : public ::testing::Test {
 protected:
  /// Where the plumb line of a sample meets the plane, by solving for it.
  double height_m(std::int64_t column) const {
    const Plumb plumb = frame_.plumb(static_cast<double>(column), kRow);
    Eigen::Matrix3d sides;
    sides << b_ - a_, c_ - a_, -plumb.up;
    return sides.fullPivLu().solve(plumb.base - a_)[2];
  }

  std::vector<double> raised(const std::vector<float>& heights_m, std::vector<double> worst_m) {
    const PlaneAlongRow plane(frame_.row(kRow), a_, (b_ - a_).cross(c_ - a_));
    plane.raise_errors(kFirst, heights_m, worst_m);
    return worst_m;
  }

  const GridShape shape_{1201, 1201};
  const GeographicPlace place_{{8, 47}, 1.0 / 1200};
  const WorldFrame world_{place_, shape_};
  const Pyramid pyramid_{shape_, 2048};
  const Lattice lattice_{pyramid_, world_, {1, 300, 4500, ""}, 2};
  const TileFrame frame_{world_, lattice_, {0, 0, 1201, 1201}, 0};
  const Plumb corners_[3] = {frame_.plumb(10, 700), frame_.plumb(1100, 800),
                             frame_.plumb(500, 1100)};
  const Eigen::Vector3d a_ = corners_[0].base + 400 * corners_[0].up;
  const Eigen::Vector3d b_ = corners_[1].base + 2400 * corners_[1].up;
  const Eigen::Vector3d c_ = corners_[2].base + 900 * corners_[2].up;
};

TEST_F(BentTile, ErrorsAreTheDistancesAlongThePlumbLines) {
  // counts that are no multiple of what is done at once, too
  for (const std::size_t count : {1U, 7U, 8U, 21U, 1000U}) {
    const auto errors_m = raised(std::vector<float>(count, 1000), std::vector<double>(count, -1));
    for (std::size_t k = 0; k < count; ++k) {
      EXPECT_NEAR(errors_m[k], std::abs(height_m(kFirst + static_cast<std::int64_t>(k)) - 1000),
                  1e-6);
    }
  }
}

TEST_F(BentTile, ErrorsOnlyRise) {
  const double off_m = std::abs(height_m(kFirst) - 1000);
  const auto errors_m = raised({1000, 1000}, {off_m + 1, off_m - 10});
  EXPECT_EQ(errors_m[0], off_m + 1);
  EXPECT_GT(errors_m[1], off_m - 10);
}

TEST_F(BentTile, SamplesWithoutDataHaveNoError) {
  const auto errors_m = raised({1000, NAN, 1000}, {-1, -1, -1});
  EXPECT_GT(errors_m[0], 0);
  EXPECT_EQ(errors_m[1], -1);
  EXPECT_GT(errors_m[2], 0);
}

}  // namespace
}  // namespace terrane::tiler

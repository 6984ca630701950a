#include "tiler/tile/tile_frame.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/tiler/test_dem.h"

namespace terrane::tiler {
namespace {

using hierarchy::GridPoint;
using hierarchy::kUnitsPerCell;
using hierarchy::Place;
using testing::GeographicPlace;

/// A tile of 64 cells of 3 arc-seconds at 46 degrees north: the curvature shows.
class GeographicTile : public ::testing::Test {
 protected:
  const GridShape shape_{1201, 1201};
  const Window window_{64, 128, 65, 65};
  const GeographicPlace place_{{8, 47}, 1.0 / 1200};
  const WorldFrame world_{place_, shape_};
  const Pyramid pyramid_{shape_, 64};
  const Lattice lattice_{pyramid_, world_, {1, 300, 4500, ""}, 2};
  const TileFrame frame_{world_, lattice_, window_, 0};
};

TEST_F(GeographicTile, FollowsTheExactMapToASmallPartOfAStep) {
  for (const auto& [column, row] : {std::pair{0.0, 0.0}, {64.0, 64.0}, {13.7, 50.2}, {0.0, 41.0}}) {
    const GridPosition position{64 + column, 128 + row};
    const Plumb exact = world_.plumbs({&position, 1}).front();
    const Plumb fitted = frame_.plumb(column, row);
    EXPECT_LT((exact.base - fitted.base).norm(), lattice_.step_m(0).x() / 64);
    EXPECT_LT((exact.up - fitted.up).norm() * 4500, lattice_.step_m(0).z() / 64);
  }
}

TEST_F(GeographicTile, PlaceIsWrittenWithinHalfAStepOnEveryAxis) {
  const GridPoint wished{20 * kUnitsPerCell + 777, -33 * kUnitsPerCell - 5000};
  const double column = hierarchy::column_of(wished), row = hierarchy::row_of(wished);
  const Place place = frame_.place(wished, 1234.56 - frame_.drop_m(column, row));
  const Plumb plumb = frame_.plumb(column, row);
  const Eigen::Vector3d off = lattice_.world(place.lattice, 0) - (plumb.base + 1234.56 * plumb.up);
  EXPECT_TRUE((off.cwiseAbs().array() <= lattice_.step_m(0).array() / 2 + 1e-9).all());
}

TEST_F(GeographicTile, PlaceOfALatticePointIsWhereItWasWritten) {
  const Place place = frame_.place({20 * kUnitsPerCell + 777, -33 * kUnitsPerCell - 5000}, 1200);
  const Place again = frame_.place_of(place.lattice);
  EXPECT_NEAR(again.plan.x, place.plan.x, 1);
  EXPECT_NEAR(again.plan.y, place.plan.y, 1);
  EXPECT_NEAR(again.height_m, place.height_m, 1e-3);
  EXPECT_EQ(again.lattice, place.lattice);
}

TEST_F(GeographicTile, DropIsTheSagittaOfTheEllipsoid) {
  // between the middle and d metres away the ellipsoid falls by d^2 / 2R, R about 6,380 km
  const double d_m = (frame_.plumb(64, 32).base - frame_.plumb(32, 32).base).norm();
  EXPECT_NEAR(frame_.drop_m(64, 32) - frame_.drop_m(32, 32), d_m * d_m / (2 * 6.38e6), 2e-3);
}

TEST_F(GeographicTile, LongEdgeAlongAParallelIsNotStraight) {
  const auto at = [&](double column) {
    return frame_.place({static_cast<std::int32_t>(column * kUnitsPerCell), 0}, 1000);
  };
  EXPECT_TRUE(frame_.is_straight(at(10), at(12)));
  EXPECT_FALSE(frame_.is_straight(at(0), at(64)));
}

TEST_F(GeographicTile, LooksDownOnTrianglesAsTheWorldHasThem) {
  const auto at = [&](double column, double row, double height_m) {
    return Place{{static_cast<std::int32_t>(column * kUnitsPerCell),
                  static_cast<std::int32_t>(-row * kUnitsPerCell)},
                 height_m - frame_.drop_m(column, row)};
  };
  const std::array places{at(3, 60, 2000), at(61, 59, 300), at(30.5, 59.25, 1500)};
  std::array<hierarchy::PlanPoint, 3> seen;
  frame_.look_down(places, seen);
  const auto& [a, b, c] = seen;
  const double units2 = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);

  const std::array<GridPosition, 4> exact_at{{{64 + 3, 128 + 60},
                                              {64 + 61, 128 + 59},
                                              {64 + 30.5, 128 + 59.25},
                                              {64 + 31.5, 128 + 59.417}}};
  const std::vector<Plumb> plumbs = world_.plumbs(exact_at);
  const auto corner = [&](int k, double height_m) -> Eigen::Vector3d {
    return plumbs[k].base + height_m * plumbs[k].up;
  };
  const Eigen::Vector3d origin = corner(0, 2000);
  const double m2 = (corner(1, 300) - origin).cross(corner(2, 1500) - origin).dot(plumbs[3].up);
  const double units_per_m = kUnitsPerCell / frame_.spacing_m();
  EXPECT_NEAR(units2 / (m2 * units_per_m * units_per_m), 1, 1e-4);
}

/// A tile of 1024 cells of 3 arc-seconds.
TEST(WideGeographicTile, SeesHowFarAParallelLiesBesideTheStraightLine) {
  const GridShape shape{1025, 1025};
  const GeographicPlace place({-124, 50}, 1.0 / 1200);
  const WorldFrame world(place, shape);
  const Pyramid pyramid(shape, 64);
  const Lattice lattice(pyramid, world, {1, 0, 2000, ""}, 5);
  const TileFrame frame(world, lattice, {0, 0, 1025, 1025}, 0);
  const auto at = [](int column) {
    return Place{{column * kUnitsPerCell, -512 * kUnitsPerCell}, 0};
  };
  const std::array places{at(352), at(672), at(512)};
  std::array<hierarchy::PlanPoint, 3> seen;
  frame.look_down(places, seen);
  const double off_cells = ((seen[0].y + seen[1].y) / 2 - seen[2].y) / kUnitsPerCell;
  // a parallel's geodesic curvature is the latitude's tangent / R
  const double latitude = (50 - 512.0 / 1200) * std::numbers::pi / 180;
  const double length_m = std::cos(latitude) * 6.388e6 * (320.0 / 1200) * std::numbers::pi / 180;
  const double sagitta_m = length_m * length_m / (8 * 6.388e6) * std::tan(latitude);
  EXPECT_NEAR(off_cells * frame.spacing_m(), sagitta_m, sagitta_m / 100);
  EXPECT_GT(320.0 * kUnitsPerCell, frame.longest_straight_units());
}

}  // namespace
}  // namespace terrane::tiler

#include "tiler/tile/tile_frame.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace terrane::tiler

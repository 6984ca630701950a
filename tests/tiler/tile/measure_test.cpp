#include "tiler/tile/measure.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "tests/tiler/test_dem.h"

namespace terrane::tiler {
namespace {

using hierarchy::kUnitsPerCell;
using testing::FunctionDem;
using testing::PlainPlace;

constexpr double kUnit_cells = 1.0 / kUnitsPerCell;

/// 65 x 65 samples at 0 m, 1 km apart, but for the one at column 20, row 20.
class MeasuredTile : public ::testing::Test {
 protected:
  explicit MeasuredTile(double height_m = 0)
      : dem_({65, 65}, [height_m](std::int64_t column, std::int64_t row) {
          return column == 20 && row == 20 ? height_m : 0;
        }) {}

  /// A vertex where it is; in plan it is known to whole units only.
  WorldVertex vertex(double column, double row, double height_m) const {
    const GridPosition position{column, row};
    const Plumb plumb = world_.plumbs({&position, 1}).front();
    const auto rounded = [](double cells) { return std::round(cells / kUnit_cells) * kUnit_cells; };
    return {{rounded(column), rounded(row), 0}, plumb.base + height_m * plumb.up};
  }

  MeasuredError measured(const MeasuredMesh& mesh, double step_m) const {
    const TileSamples samples(dem_, {0, 0, 65, 65}, 0, 1);
    return measure({&mesh, 1}, samples, frame_, step_m, 1000).errors.front();
  }

  const FunctionDem dem_;
  const PlainPlace place_{1000, 1000};
  const WorldFrame world_{place_, {65, 65}};
  const Pyramid pyramid_{{65, 65}, 64};
  const Lattice lattice_{pyramid_, world_, {1, 0, 10, ""}, 2};
  const TileFrame frame_{world_, lattice_, {0, 0, 65, 65}, 0};
};

class TileWithASpike : public MeasuredTile {
 protected:
  TileWithASpike() : MeasuredTile(5) {}
};

TEST_F(TileWithASpike, ItIsMeasuredThoughItsTrianglesRoundedPlanLeavesItOut) {
  // the edge from a to b passes the spike by 0.07 units in the world, and by -0.33 as rounded
  const std::vector<hierarchy::Corners> triangles{{0, 1, 2}};
  const MeasuredMesh mesh{.vertices = {vertex(10, 20 + 0.4 * kUnit_cells, 0),
                                       vertex(40, 20 - 0.6 * kUnit_cells, 0), vertex(20, 10, 0)},
                          .triangles = triangles,
                          .rim = {}};
  EXPECT_NEAR(measured(mesh, 0.01).max_m, 5, 0.01);
}

/// 65 x 65 samples of 0 m, 90 m apart on the sphere, whose frame is off by up to a sixth of a
/// metre.
class MeasuredOnTheEarth : public ::testing::Test {
 protected:
  static constexpr double kSide = 64;

  double exact_error_m(const std::array<Eigen::Vector3d, 3>& corners, GridPosition sample) const {
    const Plumb plumb = world_.plumbs({&sample, 1}).front();
    const Eigen::Vector3d normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    return std::abs(normal.dot(corners[0] - plumb.base) / normal.dot(plumb.up));
  }

  Eigen::Vector3d corner(GridPosition at, double height_m) const {
    const Plumb plumb = world_.plumbs({&at, 1}).front();
    return plumb.base + height_m * plumb.up;
  }

  const FunctionDem dem_{{65, 65}, [](std::int64_t, std::int64_t) { return 0; }};
  const testing::GeographicPlace place_{{8, 47}, 1.0 / 1200};
  const WorldFrame world_{place_, {65, 65}};
  const Lattice lattice_{std::vector<Eigen::Vector3d>{{500, 500, 500}}};
  const TileFrame frame_{world_, lattice_, {0, 0, 65, 65}, 0};
};

TEST_F(MeasuredOnTheEarth, StatedErrorIsNoLessThanTheExactOneHoweverSteep) {
  ASSERT_GT(frame_.accuracy_m(), 0.05) << "or this shows nothing";
  const TileSamples samples(dem_, {0, 0, 65, 65}, 0, 1);
  for (const double rise : {-100.0, -10.0, -2.0, 0.1, 2.0, 10.0, 100.0}) {
    for (const double column : {5.0, 20.0, 32.0, 50.0}) {
      // one sample 60 m under a triangle that rises from the north-west to the south-east
      const std::array<GridPosition, 3> at{
          {{column - 0.4, 30.7}, {column + 0.4, 30.8}, {column + 0.1, 31.3}}};
      MeasuredMesh mesh;
      std::array<Eigen::Vector3d, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        const double along_m = 90 * (at[k].column - column + at[k].row - 31);
        corners[k] = corner(at[k], 60 + rise * along_m);
        mesh.vertices.push_back({{at[k].column, at[k].row, 0}, corners[k]});
      }
      const std::vector<hierarchy::Corners> triangles{{0, 2, 1}};
      mesh.triangles = triangles;
      const MeasuredError error = measure({&mesh, 1}, samples, frame_, 0.01, 1000).errors.front();
      ASSERT_EQ(error.samples, 1);
      EXPECT_GE(error.max_m, exact_error_m(corners, {column, 31})) << rise << " " << column;
    }
  }
}

TEST(MeasuredPole, TrianglesWithoutAreaThereMakeNoError) {
  constexpr int kSide = 65;
  constexpr double kStep_m = 76;
  constexpr double kCell_deg = 22.5 / 64;
  const FunctionDem dem({kSide, kSide}, [](std::int64_t, std::int64_t) { return 0; });
  const testing::GeographicPlace place({0, 90}, kCell_deg);
  const WorldFrame world(place, dem.shape());
  const Lattice lattice(std::vector<Eigen::Vector3d>{{kStep_m, kStep_m, 16}});
  const TileFrame frame(world, lattice, {0, 0, kSide, kSide}, 0);
  MeasuredMesh mesh;
  std::vector<hierarchy::Corners> triangles;
  for (std::uint32_t row = 0; row < kSide; ++row) {
    for (std::uint32_t column = 0; column < kSide; ++column) {
      const GridPosition at{static_cast<double>(column), static_cast<double>(row)};
      // all of the pole's row are one place
      const GridPosition stands{row == 0 ? 0 : at.column, at.row};
      mesh.vertices.push_back({{at.column, at.row, 0}, world.plumbs({&stands, 1}).front().base});
      if (row == 0 || column == 0) continue;
      const std::uint32_t here = row * kSide + column, above = here - kSide;
      triangles.push_back({here, above, above - 1});
      triangles.push_back({here, above - 1, here - 1});
    }
  }
  mesh.triangles = triangles;
  for (std::uint32_t k = 0; k + 1 < kSide; ++k) {
    constexpr std::uint32_t kLast = kSide - 1;
    mesh.rim.push_back({k, k + 1});
    mesh.rim.push_back({kLast * kSide + k, kLast * kSide + k + 1});
    mesh.rim.push_back({k * kSide, (k + 1) * kSide});
    mesh.rim.push_back({k * kSide + kLast, (k + 1) * kSide + kLast});
  }
  const TileSamples samples(dem, {0, 0, kSide, kSide}, 0, 1);
  const MeasuredError error = measure({&mesh, 1}, samples, frame, kStep_m, 1000).errors.front();
  EXPECT_EQ(error.samples, kSide * kSide);
  EXPECT_LT(error.max_m, 1);
}

/// One height between the samples.
class OneLoose final : public LooseSamples {
 public:
  std::vector<LooseSample> in(const Window& window) const override {
    const double right = static_cast<double>(window.column + window.columns - 1);
    if (kAt.column < static_cast<double>(window.column) || kAt.column > right) return {};
    return {kAt};
  }

 private:
  static constexpr LooseSample kAt{30.25, 31.5, 8};
};

TEST_F(MeasuredTile, MeasuresSamplesBetweenThoseOfTheGrid) {
  MeasuredMesh mesh;
  mesh.vertices = {vertex(0, 64, 1), vertex(64, 64, 1), vertex(64, 0, 1), vertex(0, 0, 1)};
  const std::vector<hierarchy::Corners> triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.triangles = triangles;
  const OneLoose loose;
  const TileSamples samples(dem_, {0, 0, 65, 65}, 0, 1, &loose);
  const Measured measured = measure({&mesh, 1}, samples, frame_, 0.1, 5);
  EXPECT_NEAR(measured.errors.front().max_m, 7, 0.01);
  EXPECT_EQ(measured.errors.front().samples, 65 * 65 + 1);
  ASSERT_EQ(measured.noted.size(), 1U);
  EXPECT_EQ(measured.noted.front().column, 30.25F);
}

TEST_F(MeasuredTile, SampleBesideTheRimIsMeasuredAgainstItsNearestPoint) {
  const MeasuredMesh mesh{.vertices = {vertex(10, 20.009, 7), vertex(30, 20.009, 7),
                                       vertex(10, 20.001, 1), vertex(30, 20.001, 1)},
                          .triangles = {},
                          .rim = {{0, 1}, {2, 3}}};
  const MeasuredError error = measured(mesh, 10);  // 0.01 cells
  EXPECT_EQ(error.samples, 21);
  EXPECT_NEAR(error.max_m, 1, 0.01);
}

}  // namespace
}  // namespace terrane::tiler

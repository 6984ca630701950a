#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <GeographicLib/LocalCartesian.hpp>
#include <cmath>

#include "core/errors.h"
#include "tests/tiler/verify/fake_output.h"

namespace terrane::verify::testing {
namespace {

constexpr double kDegree_rad = 3.14159265358979323846 / 180;

/// Fake outputs on the ellipsoid, with their frame in the middle of the grid.
struct Earth {
  LonLat middle;
  GeographicPlace place;
  GeographicLib::LocalCartesian cartesian;

  Earth(LonLat middle_of_grid, const GridShape& shape, double spacing_deg)
      : middle(middle_of_grid),
        place({middle.longitude_deg - spacing_deg * static_cast<double>(shape.columns - 1) / 2,
               middle.latitude_deg + spacing_deg * static_cast<double>(shape.rows - 1) / 2},
              spacing_deg),
        cartesian(middle.latitude_deg, middle.longitude_deg, 0) {}

  ToWorld to_world() const {
    return [this](double column, double row, double height_m) {
      const PlanPosition at = place.to_plan({column, row});
      std::array<double, 3> world;
      cartesian.Forward(at.y, at.x, height_m, world[0], world[1], world[2]);
      return world;
    };
  }

  /// The tangent plane's axes in ECEF, written from the definition of longitude and latitude.
  std::vector<double> transform() const {
    const double lon = middle.longitude_deg * kDegree_rad;
    const double lat = middle.latitude_deg * kDegree_rad;
    const double a = 6378137;
    const double e2 = (2 - 1 / 298.257223563) / 298.257223563;
    const double n = a / std::sqrt(1 - e2 * std::sin(lat) * std::sin(lat));
    return {-std::sin(lon),
            std::cos(lon),
            0,
            0,
            -std::sin(lat) * std::cos(lon),
            -std::sin(lat) * std::sin(lon),
            std::cos(lat),
            0,
            std::cos(lat) * std::cos(lon),
            std::cos(lat) * std::sin(lon),
            std::sin(lat),
            0,
            n * std::cos(lat) * std::cos(lon),
            n * std::cos(lat) * std::sin(lon),
            n * (1 - e2) * std::sin(lat),
            1};
  }

  FakeOutput place_output(FakeOutput output) const {
    output.frame = {{"kind", "enu"},
                    {"longitude_deg", middle.longitude_deg},
                    {"latitude_deg", middle.latitude_deg}};
    output.root_transform = transform();
    output.lowest_m = -20000;
    output.highest_m = 20000;
    return output;
  }
};

FakeDem sea(const GridShape& shape) {
  return {shape, [](auto, auto) { return 0.0F; }};
}

TEST(VerifyOnTheEarth, AFlatTriangleCutsUnderTheSeaByItsSagitta) {
  const GridShape shape{3, 3};
  const double spacing_deg = 0.1;
  const Earth earth({10, 45}, shape, spacing_deg);
  const FakeDem dem = sea(shape);
  FakeOutput output =
      earth.place_output(repeated_grids(dem, earth.to_world(), 2, 100, {1, 1, 0.25}));
  FakeTile& tile = output.tile(0, 0, 0);
  const auto corner = [&](int column, int row) {
    return static_cast<std::uint32_t>(tile.vertex_at(column, row));
  };
  tile.triangles = {{corner(0, 0), corner(0, 2), corner(2, 2)},
                    {corner(0, 0), corner(2, 2), corner(2, 0)}};
  const VerifyReport report = verdict_on(output, dem, earth.place);
  // the chord runs north of its parallel, by 4.9 m: in at the northern border, out at the southern
  EXPECT_EQ(report.levels[0].uncovered_samples, 1);
  // the middle sample lies under the diagonal: 22.2 km to the north, 15.8 km to the west
  const double north_m = 2 * spacing_deg * kDegree_rad * 6367382;  // meridional radius at 45 N
  const double west_m = 2 * spacing_deg * kDegree_rad * 6388838 * std::cos(45 * kDegree_rad);
  const double sagitta_m = (north_m * north_m / 6367382 + west_m * west_m / 6388838) / 8;
  EXPECT_NEAR(report.levels[0].max_error_m, sagitta_m, 0.002 * sagitta_m + 0.25);
  EXPECT_GT(report.levels[0].max_error_m, 14);
}

TEST(VerifyOnTheEarth, AGridOfFifteenHundredKilometresHolds) {
  const GridShape shape{17, 17};  // 89 km apart in a row; verticals at the corners tilt by 0.15 rad
  const Earth earth({174, -41}, shape, 0.8);
  const FakeDem dem(shape, [](auto column, auto row) {
    return static_cast<float>((column * 37 + row * 61) % 50 * 80);
  });
  // rounding moves a vertex by 2 m upwards and by 45 m across; that counts where the vertical tilts
  // by 0.15 and the terrain by up to 0.09. With the frame's z for the vertical, 600 m aside, it
  // fails
  FakeOutput output = earth.place_output(repeated_grids(dem, earth.to_world(), 4, 13, {64, 64, 4}));
  output.lowest_m = -200000;
  const VerifyReport report = verdict_on(output, dem, earth.place);
  EXPECT_TRUE(report.holds()) << to_text(report);
  EXPECT_GT(report.levels[0].max_error_m, 1);
  EXPECT_EQ(report.levels[0].seam_vertices, 24 * 5);
}

TEST(VerifyOnTheEarth, HeightsCountAlongTheVerticalOfTheSample) {
  // a tile 600 km from the frame's origin would see 0.1 rad of tilt: put the frame there instead
  const GridShape shape{5, 5};
  const double spacing_deg = 0.001;
  Earth earth({170, -45}, shape, spacing_deg);
  earth.middle = {176, -41};
  earth.cartesian.Reset(earth.middle.latitude_deg, earth.middle.longitude_deg, 0);
  const FakeDem dem(shape, [](auto column, auto row) {
    return static_cast<float>(3000 + 40 * column - 25 * row);
  });
  FakeOutput output = earth.place_output(repeated_grids(dem, earth.to_world(), 4, 0.3));
  output.lowest_m = -1e6;
  const VerifyReport rounded = verdict_on(output, dem, earth.place);
  EXPECT_TRUE(rounded.holds()) << to_text(rounded);
  // lifted along its own vertical by 10 m
  FakeTile& tile = output.tile(0, 0, 0);
  const auto lifted = earth.to_world()(2, 2, dem.at(2, 2) + 10);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    tile.position[tile.vertex_at(2, 2)][axis] =
        std::llround(lifted[axis] / output.levels[0].step_m[axis]);
  }
  const VerifyReport report = verdict_on(output, dem, earth.place);
  EXPECT_NEAR(report.levels[0].max_error_m, 10, 0.3);
  EXPECT_EQ(report.levels[0].samples_over_tolerance, 1);
  EXPECT_EQ(report.levels[0].folded_triangles, 0);
}

TEST(VerifyOnTheEarth, AWrongTransformIsMisstated) {
  const GridShape shape{3, 3};
  const Earth earth({-122, 46}, shape, 0.0003);
  const FakeDem dem = sea(shape);
  FakeOutput output = earth.place_output(repeated_grids(dem, earth.to_world(), 2, 1));
  EXPECT_TRUE(verdict_on(output, dem, earth.place).holds())
      << to_text(verdict_on(output, dem, earth.place));
  output.root_transform[12] += 0.01;
  EXPECT_EQ(verdict_on(output, dem, earth.place).levels[0].facts_misstated, 1);
  output.root_transform.clear();
  EXPECT_EQ(verdict_on(output, dem, earth.place).levels[0].facts_misstated, 1);
}

TEST(VerifyOnTheEarth, ADemWithoutACrsIsRefused) {
  const GridShape shape{3, 3};
  const Earth earth({-122, 46}, shape, 0.0003);
  const FakeDem dem = sea(shape);
  const FakeOutput output = earth.place_output(repeated_grids(dem, earth.to_world(), 2, 1));
  EXPECT_THAT([&] { verdict_on(output, dem, FlatPlace()); },
              ::testing::ThrowsMessage<InputError>(::testing::HasSubstr("--crs")));
}

}  // namespace
}  // namespace terrane::verify::testing

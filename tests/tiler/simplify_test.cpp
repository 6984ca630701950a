#include "tiler/simplify.h"

#include <gmock/gmock.h>

#include <cmath>

#include "core/errors.h"
#include "tests/tiler/test_dem.h"

namespace terrane::tiler {
namespace {

using testing::FunctionDem;
using ::testing::HasSubstr;

SimplifiedTerrain simplified(const HeightSource& dem, double tolerance_m, int effort = 1) {
  NoProgress progress;
  return simplify(dem, {.tolerance_m = tolerance_m, .effort = effort}, progress);
}

TEST(Simplify, APlaneOverARectangleNeedsFewTrianglesAndLosesNothing) {
  const FunctionDem dem({65, 33}, [](auto c, auto r) { return 0.5 * c - 0.25 * r; });
  const SimplifiedTerrain terrain = simplified(dem, 0.01);
  EXPECT_EQ(terrain.input_triangles, 2 * 64 * 32);
  EXPECT_LE(terrain.mesh.triangles.size(), 32U);
  EXPECT_EQ(terrain.error.samples, 65 * 33);
  EXPECT_LE(terrain.error.max_m, 0.01);
}

TEST(Simplify, StaysWithinEveryToleranceOnRoughTerrainWithHoles) {
  const FunctionDem dem({60, 50}, [](auto c, auto r) {
    if (c > 20 && c < 26 && r > 30 && r < 34 + c % 3) return double{NAN};
    return 30 * std::sin(0.3 * c) * std::cos(0.2 * r) + (c * 7 + r * 13) % 5;
  });
  std::size_t triangles = 60 * 50 * 2;
  for (const double tolerance_m : {0.5, 2.0, 8.0}) {
    const SimplifiedTerrain terrain = simplified(dem, tolerance_m);
    EXPECT_LE(terrain.error.max_m, tolerance_m);
    EXPECT_EQ(terrain.error.uncovered, 0);
    EXPECT_EQ(terrain.error.folded, 0);
    EXPECT_LT(terrain.mesh.triangles.size(), triangles);
    triangles = terrain.mesh.triangles.size();
  }
}

TEST(Simplify, EveryStepOfEffortSavesTrianglesWithinTheSameTolerance) {
  const FunctionDem dem({90, 70}, [](auto c, auto r) {
    if (c > 20 && c < 26 && r > 30 && r < 34 + c % 3) return double{NAN};
    return 30 * std::sin(0.3 * c) * std::cos(0.2 * r) + (c * 7 + r * 13) % 3;
  });
  std::size_t triangles = 90 * 70 * 2;
  for (const int effort : {0, 1, 2, 3}) {
    const SimplifiedTerrain terrain = simplified(dem, 3, effort);
    EXPECT_LE(terrain.error.max_m, 3);
    EXPECT_EQ(terrain.error.uncovered, 0);
    EXPECT_EQ(terrain.error.folded, 0);
    EXPECT_LT(terrain.mesh.triangles.size(), triangles) << "effort " << effort;
    triangles = terrain.mesh.triangles.size();
  }
}

TEST(Simplify, RefusesAnEffortThatIsNone) {
  EXPECT_THROW(check(SimplifyOptions{.effort = 4}), ConfigError);
  EXPECT_THROW(check(SimplifyOptions{.effort = -1}), ConfigError);
}

TEST(Simplify, SamplesThatNoTriangleTouchesAreNoPartOfTheTerrain) {
  const FunctionDem dem({9, 9}, [](auto c, auto r) {
    return c == 8 && r == 8 ? 5.0 : c > 5 || r > 5 ? double{NAN} : 0.0;
  });
  const GridError error = simplified(dem, 1).error;
  EXPECT_EQ(error.samples, 36);
  EXPECT_EQ(error.uncovered, 1);
}

template <class Action>
std::string message_of(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Simplify, RefusesADemWithoutTriangles) {
  const FunctionDem dem({9, 9}, [](auto c, auto r) { return (c + r) % 2 ? 1.0 : double{NAN}; });
  EXPECT_THROW(simplified(dem, 1), InputError);
  EXPECT_THAT(message_of([&] { simplified(dem, 1); }), HasSubstr("--nodata"));
}

TEST(Simplify, RefusesADemThatIsTooLargeAndSaysWhatToUse) {
  const FunctionDem dem({6000, 6000}, [](auto, auto) { return 0; });
  EXPECT_THROW(simplified(dem, 1), InputError);
  EXPECT_THAT(message_of([&] { simplified(dem, 1); }), HasSubstr("terrane build"));
}

TEST(Simplify, RefusesAToleranceThatTheStepsOfHeightsCannotKeep) {
  NoProgress progress;
  const FunctionDem dem({5, 5}, [](auto c, auto r) { return 0.3 * c + 0.4 * r; });
  const auto in_whole_metres = [&] {
    simplify(dem, {.tolerance_m = 0.01, .height_steps_per_m = 1}, progress);
  };
  EXPECT_THROW(in_whole_metres(), ConfigError);
  EXPECT_THAT(message_of(in_whole_metres), HasSubstr("--tolerance"));
}

TEST(Simplify, RefusesToleranceThatIsNoPositiveNumber) {
  EXPECT_THROW(check(SimplifyOptions{.tolerance_m = 0}), ConfigError);
  EXPECT_THROW(check(SimplifyOptions{.tolerance_m = NAN}), ConfigError);
}

}  // namespace
}  // namespace terrane::tiler

#include "tiler/simplify.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

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

/// Hills with holes, one of them on the corner of four tiles, over several tiles.
FunctionDem hills_with_holes() {
  return FunctionDem({600, 530}, [](auto c, auto r) {
    if (c > 500 && c < 526 && r > 505 && r < 520) return double{NAN};
    if (c > 200 && c < 226 && r > 300 && r < 334 + c % 3) return double{NAN};
    return 30 * std::sin(0.1 * c) * std::cos(0.07 * r) + (c * 7 + r * 13) % 5;
  });
}

SimplifiedTerrain in_tiles(const HeightSource& dem, double tolerance_m) {
  NoProgress progress;
  return simplify(dem, {.tolerance_m = tolerance_m, .most_samples_at_once = 1000}, progress);
}

TEST(SimplifyInTiles, KeepsTheToleranceAtEverySampleThatOneMeshWouldCover) {
  const FunctionDem dem = hills_with_holes();
  const SimplifiedTerrain whole = simplified(dem, 4), tiled = in_tiles(dem, 4);
  EXPECT_EQ(tiled.input_triangles, whole.input_triangles);
  EXPECT_EQ(tiled.error.samples, whole.error.samples);
  EXPECT_LE(tiled.error.max_m, 4);
  EXPECT_EQ(tiled.error.folded, 0);
  EXPECT_LT(tiled.mesh.triangles.size(), 1.1 * static_cast<double>(whole.mesh.triangles.size()));
}

/// Edges that one triangle alone has, of those not on the rim of a 600 x 530 grid or its holes.
std::int64_t open_edges_inside(const hierarchy::TerrainMesh& mesh, const FunctionDem& dem) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  for (const auto& corners : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      ++uses[std::minmax({corners[k], corners[(k + 1) % 3]})];
    }
  }
  const auto is_rim = [&](std::uint32_t v) {
    const auto c = std::lround(hierarchy::column_of(mesh.vertices[v].place.plan));
    const auto r = std::lround(hierarchy::row_of(mesh.vertices[v].place.plan));
    if (c == 0 || r == 0 || c == dem.shape().columns - 1 || r == dem.shape().rows - 1) return true;
    for (const float height_m : dem.read({c - 1, r - 1, 3, 3}).heights_m) {
      if (std::isnan(height_m)) return true;
    }
    return false;
  };
  return std::ranges::count_if(uses, [&](const auto& use) {
    return use.second == 1 && !(is_rim(use.first.first) && is_rim(use.first.second));
  });
}

TEST(SimplifyInTiles, WeldsTheSeamsToOneMesh) {
  const FunctionDem dem = hills_with_holes();
  EXPECT_EQ(open_edges_inside(in_tiles(dem, 4).mesh, dem), 0);
}

TEST(SimplifyInTiles, KeepsALineThatCrossesASeam) {
  const FunctionDem dem({600, 100}, [](auto c, auto r) { return 0.1 * c + 0.2 * r; });
  // every column that the line crosses is one of its points (core/grid_features.h)
  FeatureLine line;
  for (int c = 500; c <= 520; ++c) line.points.push_back({static_cast<double>(c), 50.5});
  NoProgress progress;
  const SimplifiedTerrain terrain =
      simplify(dem, {.tolerance_m = 1, .features = {.lines = {line}}, .most_samples_at_once = 1000},
               progress);
  double length = 0;
  for (const auto& [a, b] : terrain.mesh.lines) {
    const auto from = terrain.mesh.vertices[a].place.plan, to = terrain.mesh.vertices[b].place.plan;
    length += std::abs(hierarchy::column_of(from) - hierarchy::column_of(to));
    EXPECT_NEAR(hierarchy::row_of(from), 50.5, 1);
  }
  EXPECT_NEAR(length, 20, 1e-9);
}

TEST(SimplifyInTiles, RefusesADemWithoutTriangles) {
  const FunctionDem dem({99, 99}, [](auto c, auto r) { return (c + r) % 2 ? 1.0 : double{NAN}; });
  EXPECT_THAT(message_of([&] { in_tiles(dem, 1); }), HasSubstr("--nodata"));
}

TEST(Simplify, RefusesADemThatIsTooLongAndSaysWhatToUse) {
  const FunctionDem dem({200000, 2}, [](auto, auto) { return 0; });
  EXPECT_THROW(simplified(dem, 1), InputError);
  EXPECT_THAT(message_of([&] { simplified(dem, 1); }), HasSubstr("gdal_translate"));
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

#include "tiler/tile/triangles_in_water.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/hierarchy/test_meshes.h"

namespace terrane::tiler {
namespace {

using hierarchy::Corners;
using hierarchy::LinedTriangles;

/// A rectangular shore along columns and rows of samples.
FeatureLine rectangle(int left, int top, int right, int bottom) {
  FeatureLine line{{}, 0.0};
  int x = left, y = top;
  const auto go = [&](int to_x, int to_y) {
    while (x != to_x || y != to_y) {
      line.points.push_back({static_cast<double>(x), static_cast<double>(y)});
      x += (to_x > x) - (to_x < x);
      y += (to_y > y) - (to_y < y);
    }
  };
  go(right, top);
  go(right, bottom);
  go(left, bottom);
  go(left, top);
  line.points.push_back(line.points.front());
  return line;
}

/// A lake from (2, 2) to (9, 9) with an island of one cell, whose four samples lie on its shore.
struct Lake : ::testing::Test {
  std::vector<FeatureLine> lines{rectangle(2, 2, 9, 9), rectangle(5, 5, 6, 6)};
  GridFeatures features;
  HeightGrid grid = hierarchy::testing::grid_of(12, 12, [](auto, auto) { return 0.0; });
  LinedTriangles full = hierarchy::triangulate_with_lines(grid, grid.window, lines);
  std::vector<hierarchy::BorderPlace> places = hierarchy::places_of(full, grid.window);

  Lake() {
    features.lines = lines;
    features.shores = {2};
  }

  static bool is_inside(const hierarchy::SampleId& s) {
    return s.column >= 2 && s.column <= 9 && s.row >= 2 && s.row <= 9;  // shores count as water
  }

  double wet_area_cells() const {
    const auto in_water = triangles_in_water(full, places, lines, is_inside, WaterAreas(features));
    double area = 0;
    for (std::size_t t = 0; t < in_water.size(); ++t) {
      if (in_water[t] == 0) continue;
      const auto& [a, b, c] = full.triangles[t];
      area += std::abs((places[b].column - places[a].column) * (places[c].row - places[a].row) -
                       (places[c].column - places[a].column) * (places[b].row - places[a].row)) /
              2;
    }
    return area;
  }
};

TEST_F(Lake, HoldsItsAreaLessThatOfAnIslandAllOfWhoseSamplesAreOnItsShore) {
  EXPECT_DOUBLE_EQ(wet_area_cells(), 7 * 7 - 1);
}

TEST_F(Lake, LandBetweenTwoShoresAtTheWatersHeightIsLand) {
  // a second lake one cell away: the samples between them are on shores, all of them
  lines.push_back(rectangle(10, 2, 11, 9));
  features.lines = lines;
  features.shores = {2, 1};
  full = hierarchy::triangulate_with_lines(grid, grid.window, lines);
  places = hierarchy::places_of(full, grid.window);
  EXPECT_DOUBLE_EQ(wet_area_cells(), 7 * 7 - 1 + 7);
}

TEST_F(Lake, WithoutWaterThereAreNoMarks) {
  features.shores.clear();
  const auto none = [](const hierarchy::SampleId&) { return false; };
  EXPECT_TRUE(triangles_in_water(full, places, lines, none, WaterAreas(features)).empty());
}

}  // namespace
}  // namespace terrane::tiler

#include "tiler/tile/water_areas.h"

#include <gtest/gtest.h>

namespace terrane::tiler {
namespace {

/// A square shore laid on the grid: a point at each crossing with a column or row.
FeatureLine square(int left, int top, int side, double height_m = 100) {
  FeatureLine line{{}, height_m};
  const int steps[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  int x = left, y = top;
  for (const auto& [dx, dy] : steps) {
    for (int i = 0; i < side; ++i, x += dx, y += dy) {
      line.points.push_back({x + 0.25, y + 0.25});
      // crosses the next column or row on the way
      line.points.push_back({x + 0.25 +
                                 (dx > 0   ? 0.75
                                  : dx < 0 ? -0.25
                                           : 0),
                             y + 0.25 +
                                 (dy > 0   ? 0.75
                                  : dy < 0 ? -0.25
                                           : 0)});
    }
  }
  line.points.push_back(line.points.front());
  return line;
}

WaterAreas areas(std::vector<FeatureLine> lines, std::vector<std::size_t> shores) {
  GridFeatures features;
  features.lines = std::move(lines);
  features.shores = std::move(shores);
  return WaterAreas(features);
}

TEST(WaterAreas, HoldWhatIsInsideAShore) {
  const WaterAreas lake = areas({square(2, 2, 6)}, {1});
  EXPECT_TRUE(lake.height_m({2.3, 2.3}));
  EXPECT_TRUE(lake.height_m({8.2, 8.2}));
  EXPECT_FALSE(lake.height_m({2.2, 5}));
  EXPECT_FALSE(lake.height_m({8.3, 5}));
  EXPECT_FALSE(lake.height_m({5, 2.2}));
  EXPECT_FALSE(lake.height_m({5, 8.3}));
  EXPECT_FALSE(lake.height_m({5, 1000}));
}

TEST(WaterAreas, LeaveIslandsOutAndHoldTheLakesOnThem) {
  const WaterAreas lakes = areas({square(0, 0, 12), square(2, 2, 8), square(4, 4, 3)}, {2, 1});
  EXPECT_TRUE(lakes.height_m({1, 6})) << "between shore and island";
  EXPECT_FALSE(lakes.height_m({3, 6})) << "on the island";
  EXPECT_TRUE(lakes.height_m({5, 6})) << "in the lake on the island";
  EXPECT_FALSE(lakes.height_m({8, 6}));
  EXPECT_TRUE(lakes.height_m({11, 6}));
}

TEST(WaterAreas, WhereTwoBodiesOverlapTheLaterOneTellsItsHeight) {
  const WaterAreas lakes = areas({square(0, 0, 6), square(3, 3, 6, 70)}, {1, 1});
  EXPECT_EQ(lakes.height_m({1, 1}), 100);
  EXPECT_EQ(lakes.height_m({4, 4}), 70);
  EXPECT_TRUE(lakes.height_m({1, 1}));
  EXPECT_TRUE(lakes.height_m({4, 4}));
  EXPECT_TRUE(lakes.height_m({8, 8}));
  EXPECT_FALSE(lakes.height_m({8, 1}));
}

TEST(WaterAreas, LinesThatAreNoShoresHoldNothing) {
  EXPECT_FALSE(areas({square(0, 0, 6)}, {}).height_m({3, 3}));
}

}  // namespace
}  // namespace terrane::tiler

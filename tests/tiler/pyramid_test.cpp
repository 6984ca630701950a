#include "tiler/pyramid.h"

#include <gtest/gtest.h>

namespace terrane::tiler {
namespace {

TEST(Pyramid, HasOneLevelForADemOfOneTile) {
  EXPECT_EQ(Pyramid({65, 65}, 64).level_count(), 1);
  EXPECT_EQ(Pyramid({66, 65}, 64).level_count(), 2);
  EXPECT_EQ(Pyramid({2, 2}, 64).level_count(), 1);
}

TEST(Pyramid, TilesOfEveryLevelCoverEveryCellOnce) {
  const Pyramid pyramid({327, 468}, 64);
  EXPECT_EQ(pyramid.tiles(0).size(), 6U * 8);
  EXPECT_EQ(pyramid.tiles(1).size(), 3U * 4);
  EXPECT_EQ(pyramid.tiles(pyramid.root_level()).size(), 1U);
  for (int level = 0; level < pyramid.level_count(); ++level) {
    std::int64_t cells = 0;
    for (const TileId& tile : pyramid.tiles(level)) {
      const Window window = pyramid.window(tile);
      cells += (window.columns - 1) * (window.rows - 1);
    }
    EXPECT_EQ(cells, 326 * 467) << "level " << level;
  }
}

TEST(Pyramid, LevelsOfAnOctaveHaveTheSameTiles) {
  const Pyramid pyramid({327, 468}, 64, 3);
  EXPECT_EQ(pyramid.level_count(), 10);
  for (const int level : {0, 1, 2}) EXPECT_EQ(pyramid.tiles(level).size(), 6U * 8) << level;
  for (const int level : {3, 4, 5}) EXPECT_EQ(pyramid.tiles(level).size(), 3U * 4) << level;
  EXPECT_EQ(pyramid.tiles(pyramid.root_level()).size(), 1U);
  EXPECT_EQ(pyramid.window({2, 1, 1}), pyramid.window({0, 1, 1}));
  EXPECT_EQ(pyramid.children({2, 1, 1}), (std::vector<TileId>{{1, 1, 1}}));
  EXPECT_EQ(pyramid.parent({1, 1, 1}), (TileId{2, 1, 1}));
  EXPECT_EQ(pyramid.children({3, 1, 1}),
            (std::vector<TileId>{{2, 2, 2}, {2, 3, 2}, {2, 2, 3}, {2, 3, 3}}));
  EXPECT_EQ(pyramid.parent({2, 3, 2}), (TileId{3, 1, 1}));
}

TEST(Pyramid, ChildrenCoverTheirParent) {
  const Pyramid pyramid({200, 70}, 64);
  EXPECT_EQ(pyramid.children({1, 0, 0}).size(), 4U);
  EXPECT_EQ(pyramid.children({1, 1, 0}).size(), 4U);
  EXPECT_EQ(pyramid.children({2, 0, 0}).size(), 2U);
  EXPECT_TRUE(pyramid.children({0, 0, 0}).empty());
}

TEST(Pyramid, MarginStopsAtTheDemsEdge) {
  const Pyramid pyramid({200, 70}, 64);
  EXPECT_EQ(pyramid.window({0, 1, 0}, 3), (Window{61, 0, 71, 68}));
}

TEST(Pyramid, SeamsLieBetweenTilesAndNotOnTheDemsEdge) {
  const Pyramid pyramid({129, 129}, 64);
  EXPECT_TRUE(pyramid.is_on_seam({0, 0, 0}, 64, 10));
  EXPECT_TRUE(pyramid.is_on_seam({0, 1, 0}, 64, 10));
  EXPECT_FALSE(pyramid.is_on_seam({0, 0, 0}, 0, 10));
  EXPECT_FALSE(pyramid.is_on_seam({0, 1, 0}, 128, 10));
  EXPECT_FALSE(pyramid.is_on_seam({1, 0, 0}, 64, 10));
}

}  // namespace
}  // namespace terrane::tiler

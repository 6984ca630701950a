#include "archive/pmtiles_tile_id.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace terrane::archive {
namespace {

// The table of the PMTiles specification, chapter 4.1.
TEST(TileId, IsThatOfTheSpecification) {
  EXPECT_EQ(tile_id_of({0, 0, 0}), 0u);
  EXPECT_EQ(tile_id_of({1, 0, 0}), 1u);
  EXPECT_EQ(tile_id_of({1, 0, 1}), 2u);
  EXPECT_EQ(tile_id_of({1, 1, 1}), 3u);
  EXPECT_EQ(tile_id_of({1, 1, 0}), 4u);
  EXPECT_EQ(tile_id_of({2, 0, 0}), 5u);
  EXPECT_EQ(tile_id_of({12, 3423, 1763}), 19078479u);
}

TEST(TileId, NumbersEveryTileOnce) {
  for (int zoom = 0; zoom <= 7; ++zoom) {
    for (std::uint64_t id = first_id_of_zoom(zoom); id < first_id_of_zoom(zoom + 1); ++id) {
      const ZoomTile tile = tile_at(id);
      ASSERT_EQ(tile.zoom, zoom);
      ASSERT_EQ(tile_id_of(tile), id);
    }
  }
}

TEST(TileId, NeighboursOnTheCurveAreNeighboursOnTheGround) {
  for (std::uint64_t id = first_id_of_zoom(6) + 1; id < first_id_of_zoom(7); ++id) {
    const ZoomTile a = tile_at(id - 1);
    const ZoomTile b = tile_at(id);
    const auto steps = std::abs(static_cast<int>(a.x) - static_cast<int>(b.x)) +
                       std::abs(static_cast<int>(a.y) - static_cast<int>(b.y));
    ASSERT_EQ(steps, 1) << id;
  }
}

TEST(TileId, HoldsTheDeepestZoom) {
  const std::uint32_t last = (std::uint32_t{1} << kLargestZoom) - 1;
  for (const ZoomTile& tile : {ZoomTile{kLargestZoom, 0, 0}, ZoomTile{kLargestZoom, last, last},
                               ZoomTile{kLargestZoom, last, 0}, ZoomTile{kLargestZoom, 5, last}}) {
    EXPECT_EQ(tile_at(tile_id_of(tile)), tile);
    EXPECT_LT(tile_id_of(tile), first_id_of_zoom(kLargestZoom + 1));
  }
}

}  // namespace
}  // namespace terrane::archive

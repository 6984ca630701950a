#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <string>
#include <vector>

#include "core/height_grid.h"

namespace terrane::verify {

/// Names one tile; x grows with the column, y with the row.
struct TileKey {
  int level = 0;
  std::int64_t x = 0;
  std::int64_t y = 0;

  auto operator<=>(const TileKey&) const = default;
  TileKey parent() const { return {level + 1, x / 2, y / 2}; }
};

/// The side of a tile towards a neighbour.
enum class Side { kWest, kEast, kNorth, kSouth };

inline constexpr std::array<Side, 4> kSides = {Side::kWest, Side::kEast, Side::kNorth,
                                               Side::kSouth};

Side opposite(Side side);

/// The tile of the same level beyond a side; it may lie outside the DEM.
TileKey neighbour(const TileKey& key, Side side);

/// True if a tile's side is part of that side of its parent.
bool is_on_side(const TileKey& child, Side side);

/// "tile 0/3/4": level, x, y, as in the file name.
std::string to_string(const TileKey& key);

/// Which samples each tile of a DEM covers (docs/formats.md, "Tiles").
struct Tiling {
  GridShape shape;
  std::int64_t tile_cells = 64;

  /// Levels up to the one with a single tile.
  int level_count() const;
  std::int64_t tile_columns(int level) const;
  std::int64_t tile_rows(int level) const;
  bool has(const TileKey& key) const;

  /// Samples of a tile, both borders included, cut off at the DEM's end.
  Window window(const TileKey& key) const;

  /// Up to four tiles of the level below, those outside the DEM left out, in the order of rows.
  std::vector<TileKey> children(const TileKey& key) const;

  /// The tile itself and all below it, children before their parent.
  std::vector<TileKey> subtree(const TileKey& key) const;
};

/// The window and one sample more on every side that is not the DEM's end.
Window with_ring(const Window& window, const GridShape& shape);

}  // namespace terrane::verify

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
};

/// The side of a tile towards a neighbour.
enum class Side { kWest, kEast, kNorth, kSouth };

inline constexpr std::array<Side, 4> kSides = {Side::kWest, Side::kEast, Side::kNorth,
                                               Side::kSouth};

Side opposite(Side side);

/// The tile of the same level beyond a side; it may lie outside the DEM.
TileKey neighbour(const TileKey& key, Side side);

/// "tile 0/3/4": level, x, y, as in the file name.
std::string to_string(const TileKey& key);

/// Which samples each tile of a DEM covers (docs/formats.md, "Tiles").
struct Tiling {
  GridShape shape;
  std::int64_t tile_cells = 64;
  int levels_per_octave = 1;  ///< levels in a row with the same tiles

  /// Levels up to the one with a single tile.
  int level_count() const;
  /// How often tiles have doubled in size at a level.
  int octave(int level) const { return level / levels_per_octave; }
  std::int64_t tile_columns(int level) const;
  std::int64_t tile_rows(int level) const;
  bool has(const TileKey& key) const;

  /// Samples of a tile, both borders included, cut off at the DEM's end.
  Window window(const TileKey& key) const;

  TileKey parent(const TileKey& key) const;

  /// The tile of a level that a leaf tile's samples are in.
  TileKey above(const TileKey& leaf, int level) const;

  /// True if a tile's side is part of that side of its parent.
  bool is_on_side(const TileKey& child, Side side) const;

  /// Up to four tiles of the level below, those outside the DEM left out, in the order of rows; or
  /// the one at the same place, where tiles do not double in size.
  std::vector<TileKey> children(const TileKey& key) const;

  /// The tile itself and all below it, children before their parent.
  std::vector<TileKey> subtree(const TileKey& key) const;
};

/// The window and one sample more on every side that is not the DEM's end.
Window with_ring(const Window& window, const GridShape& shape);

}  // namespace terrane::verify

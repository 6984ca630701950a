#pragma once

#include <cstdint>
#include <vector>

#include "core/height_grid.h"
#include "tiler/tile_id.h"

namespace terrane::tiler {

/// The native quadtree over a DEM: leaf tiles of tile_cells x tile_cells cells from the first
/// sample on, ragged at the last columns and rows, four tiles to one, until one is left.
///
/// With levels_per_octave k, k levels in a row have the same tiles (a tile is a *stack* of k
/// meshes), and every k-th step up puts four tiles into one:
///
///     level        0   1   2   3   4   5   6        k = 3
///     octave       0   0   0   1   1   1   2
///     cells        64  64  64  128 128 128 256      the last level is the first with one tile
class Pyramid {
 public:
  /// \param tile_cells  cells along a leaf tile, 1 or more.
  /// \param levels_per_octave  levels that share a size of tiles, 1 or more.
  /// \param goes_round  the last column is the same meridian as the first.
  Pyramid(GridShape shape, std::int64_t tile_cells, int levels_per_octave = 1,
          bool goes_round = false);

  int level_count() const { return level_count_; }
  int root_level() const { return level_count_ - 1; }
  std::int64_t leaf_cells() const { return tile_cells_; }
  /// How often tiles have doubled in size at a level.
  int octave(int level) const { return level / levels_per_octave_; }

  /// Does the DEM reach into the tile?
  /// \pre neither x nor y is negative.
  bool holds(const TileId& tile) const;
  /// Tiles of a level, row by row.
  std::vector<TileId> tiles(int level) const;
  /// The tile of the next level that a tile is part of, or the same place.
  TileId parent(const TileId& tile) const;
  /// The children of a tile that the DEM reaches: up to four, or one at the same place; none at
  /// level 0.
  std::vector<TileId> children(const TileId& tile) const;
  /// The samples of a tile, those of its borders included.
  Window window(const TileId& tile) const;
  /// The samples of a tile and up to \p margin more on each side, as far as the DEM goes.
  Window window(const TileId& tile, std::int64_t margin) const;

  /// Does a place, in cells, lie on a border that the tile shares with a neighbour's place? Round
  /// the Earth, too.
  bool is_on_seam(const TileId& tile, double column, double row) const;

 private:
  std::int64_t cells_per_side(int level) const { return tile_cells_ << octave(level); }
  bool doubles_above(int level) const { return octave(level + 1) > octave(level); }

  GridShape shape_;
  std::int64_t tile_cells_;
  int levels_per_octave_;
  bool goes_round_;
  int level_count_ = 1;
};

}  // namespace terrane::tiler

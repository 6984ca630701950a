#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/height_source.h"
#include "core/progress.h"
#include "tiler/verify/tiling.h"

namespace terrane::verify {

/// A line of samples along the border of tiles: a column, or a row, with a range along it.
struct Line {
  bool is_column = true;
  std::int64_t at = 0;    ///< its column (or row)
  std::int64_t from = 0;  ///< first and last row (or column) of the range
  std::int64_t to = 0;
};

Line side_line(const Window& tile_window, Side side);

/// A stretch of a line, both ends included.
using Run = std::pair<std::int64_t, std::int64_t>;

/// Which parts of the DEM are terrain: a cell with four heights is two triangles, one with three is
/// one, others none.
class ValidDomain {
 public:
  /// One pass over the DEM, leaf tile by leaf tile.
  ValidDomain(const HeightSource& heights, const Tiling& tiling, Progress& progress);

  /// True if the tile covers at least one triangle of the DEM.
  bool has_triangles(const TileKey& key) const;

  /// Maximal stretches of a line between leaf tiles where every step from sample to sample has a
  /// triangle on both sides. None on the DEM's own border.
  std::vector<Run> shared_runs(const Line& line) const;

 private:
  void read_leaf(const HeightSource& heights, const TileKey& leaf);
  void note_line(const HeightGrid& grid, const Line& line);
  std::size_t index_of(const Line& line, std::int64_t along) const;

  Tiling tiling_;
  std::vector<std::vector<std::uint8_t>> has_triangles_;  // per level, tile by tile
  std::vector<std::uint8_t> columns_;  // per step of the columns between leaf tiles: is shared
  std::vector<std::uint8_t> rows_;
};

/// Heights of the four samples of a cell that are there.
int cell_heights(const HeightGrid& grid, std::int64_t column, std::int64_t row);

}  // namespace terrane::verify

#pragma once

#include <algorithm>
#include <cstdint>

#include "core/height_grid.h"
#include "tiler/tile/tile_frame.h"

namespace terrane::tiler {

/// The samples of a patch, in metres over the curved datum of its tile's frame.
struct DatumHeights {
  const HeightGrid& grid;
  const Window& tile;
  const TileFrame& frame;

  /// \param column, row  of the DEM.
  double at(std::int64_t column, std::int64_t row) const {
    return grid.at(column, row) - frame.drop_m(static_cast<double>(column - tile.column),
                                               static_cast<double>(row - tile.row));
  }

  /// Calls visit(column, row, height) for the samples of a window that have data, row by row;
  /// columns and rows count from the tile's first sample.
  template <class Visit>
  void for_each(const Window& window, const Visit& visit) const {
    for (std::int64_t row = window.row; row < window.row + window.rows; ++row) {
      for (std::int64_t column = window.column; column < window.column + window.columns; ++column) {
        if (!grid.has_data(column, row)) continue;
        visit(static_cast<double>(column - tile.column), static_cast<double>(row - tile.row),
              at(column, row));
      }
    }
  }
};

/// Calls visit(part) for each square part of a window, row by row, the last ones cut off by it.
template <class Visit>
void for_each_part(const Window& window, std::int64_t side, const Visit& visit) {
  for (std::int64_t row = 0; row < window.rows; row += side) {
    for (std::int64_t column = 0; column < window.columns; column += side) {
      visit(Window{window.column + column, window.row + row,
                   std::min(side, window.columns - column), std::min(side, window.rows - row)});
    }
  }
}

}  // namespace terrane::tiler

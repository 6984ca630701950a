#include "tiler/tile/grid_census.h"

#include <algorithm>

namespace terrane::tiler {
namespace {

/// Triangles of the cell whose first sample this is; none outside the grid.
int triangles_of_cell(const HeightGrid& grid, std::int64_t column, std::int64_t row) {
  const Window& window = grid.window;
  if (column < window.column || column >= window.column + window.columns - 1) return 0;
  if (row < window.row || row >= window.row + window.rows - 1) return 0;
  int corners = 0;
  for (const std::int64_t c : {column, column + 1}) {
    for (const std::int64_t r : {row, row + 1}) corners += grid.has_data(c, r) ? 1 : 0;
  }
  return std::max(0, corners - 2);
}

bool is_corner(const HeightGrid& grid, std::int64_t column, std::int64_t row) {
  if (!grid.has_data(column, row)) return false;
  for (const std::int64_t c : {column - 1, column}) {
    for (const std::int64_t r : {row - 1, row}) {
      if (triangles_of_cell(grid, c, r) > 0) return true;
    }
  }
  return false;
}

}  // namespace

GridCensus count_grid(const HeightSource& heights, std::int64_t samples_at_once) {
  const GridShape shape = heights.shape();
  const std::int64_t rows_at_once = std::max<std::int64_t>(1, samples_at_once / shape.columns);
  GridCensus census;
  for (std::int64_t first = 0; first < shape.rows; first += rows_at_once) {
    const std::int64_t end = std::min(first + rows_at_once, shape.rows);
    // the cells above the first row and below the last count for their samples
    const std::int64_t top = std::max<std::int64_t>(0, first - 1);
    const std::int64_t bottom = std::min(end + 1, shape.rows);
    const HeightGrid strip = heights.read({0, top, shape.columns, bottom - top});
    for (std::int64_t row = first; row < end; ++row) {
      for (std::int64_t column = 0; column < shape.columns; ++column) {
        census.samples += is_corner(strip, column, row) ? 1 : 0;
        census.triangles += triangles_of_cell(strip, column, row);
      }
    }
  }
  return census;
}

}  // namespace terrane::tiler

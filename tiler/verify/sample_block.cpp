#include "tiler/verify/sample_block.h"

#include "tiler/verify/valid_domain.h"

namespace terrane::verify {
namespace {

bool touches_triangle(const HeightGrid& grid, std::int64_t column, std::int64_t row) {
  const Window& window = grid.window;
  for (std::int64_t y = row - 1; y <= row; ++y) {
    for (std::int64_t x = column - 1; x <= column; ++x) {
      const bool is_cell = x >= window.column && y >= window.row &&
                           x + 1 < window.column + window.columns &&
                           y + 1 < window.row + window.rows;
      if (is_cell && cell_heights(grid, x, y) >= 3) return true;
    }
  }
  return false;
}

}  // namespace

bool SampleBlock::is_rim(std::int64_t column, std::int64_t row) const {
  return column == window.column || row == window.row ||
         column == window.column + window.columns - 1 || row == window.row + window.rows - 1;
}

SampleBlock read_sample_block(const HeightSource& heights, const World& world, const Tiling& tiling,
                              const TileKey& leaf) {
  SampleBlock block{.leaf = leaf, .window = tiling.window(leaf)};
  const Window& window = block.window;
  const HeightGrid grid = heights.read(with_ring(window, tiling.shape));
  block.samples.resize(static_cast<std::size_t>(window.columns * window.rows));
  std::vector<GridPosition> positions;
  std::vector<std::size_t> terrain;
  for (std::int64_t row = window.row; row < window.row + window.rows; ++row) {
    for (std::int64_t column = window.column; column < window.column + window.columns; ++column) {
      if (!grid.has_data(column, row) || !touches_triangle(grid, column, row)) continue;
      positions.push_back({static_cast<double>(column), static_cast<double>(row)});
      terrain.push_back(block.index(column, row));
    }
  }
  const std::vector<Plumb> plumbs = world.plumb(positions);
  for (std::size_t n = 0; n < plumbs.size(); ++n) {
    const double height_m = grid.at(static_cast<std::int64_t>(positions[n].column),
                                    static_cast<std::int64_t>(positions[n].row));
    const Plumb& plumb = plumbs[n];
    block.samples[terrain[n]] = {plumb.base + height_m * plumb.up, plumb.up, true};
  }
  return block;
}

}  // namespace terrane::verify

#include "tiler/verify/valid_domain.h"

namespace terrane::verify {
namespace {

bool any_triangle(const HeightGrid& grid, const Window& tile) {
  for (std::int64_t row = tile.row; row + 1 < tile.row + tile.rows; ++row) {
    for (std::int64_t column = tile.column; column + 1 < tile.column + tile.columns; ++column) {
      if (cell_heights(grid, column, row) >= 3) return true;
    }
  }
  return false;
}

/// True if the step from one sample of a line to the next has a triangle on both sides.
bool is_shared_step(const HeightGrid& grid, const Line& line, std::int64_t along) {
  const auto has_data = [&](std::int64_t across, std::int64_t step) {
    return line.is_column ? grid.has_data(line.at + across, along + step)
                          : grid.has_data(along + step, line.at + across);
  };
  const auto any = [&](std::int64_t across) { return has_data(across, 0) || has_data(across, 1); };
  return has_data(0, 0) && has_data(0, 1) && any(-1) && any(1);
}

}  // namespace

int cell_heights(const HeightGrid& grid, std::int64_t column, std::int64_t row) {
  return grid.has_data(column, row) + grid.has_data(column + 1, row) +
         grid.has_data(column, row + 1) + grid.has_data(column + 1, row + 1);
}

Line side_line(const Window& tile, Side side) {
  const std::int64_t last_column = tile.column + tile.columns - 1;
  const std::int64_t last_row = tile.row + tile.rows - 1;
  switch (side) {
    case Side::kWest:
      return {true, tile.column, tile.row, last_row};
    case Side::kEast:
      return {true, last_column, tile.row, last_row};
    case Side::kNorth:
      return {false, tile.row, tile.column, last_column};
    case Side::kSouth:
      break;
  }
  return {false, last_row, tile.column, last_column};
}

ValidDomain::ValidDomain(const HeightSource& heights, const Tiling& tiling, Progress& progress)
    : tiling_(tiling) {
  for (int level = 0; level < tiling.level_count(); ++level) {
    const std::int64_t tiles = tiling.tile_columns(level) * tiling.tile_rows(level);
    has_triangles_.emplace_back(static_cast<std::size_t>(tiles), std::uint8_t{0});
  }
  const std::int64_t leaf_columns = tiling.tile_columns(0);
  const std::int64_t leaf_rows = tiling.tile_rows(0);
  columns_.resize(static_cast<std::size_t>((leaf_columns - 1) * tiling.shape.rows));
  rows_.resize(static_cast<std::size_t>((leaf_rows - 1) * tiling.shape.columns));
  progress.begin("finding the terrain", leaf_columns * leaf_rows);
  for (std::int64_t y = 0; y < leaf_rows; ++y) {
    for (std::int64_t x = 0; x < leaf_columns; ++x) {
      read_leaf(heights, {0, x, y});
      progress.advance(1);
    }
  }
}

void ValidDomain::read_leaf(const HeightSource& heights, const TileKey& leaf) {
  const Window tile = tiling_.window(leaf);
  const HeightGrid grid = heights.read(with_ring(tile, tiling_.shape));
  note_line(grid, side_line(tile, Side::kEast));
  note_line(grid, side_line(tile, Side::kSouth));
  if (!any_triangle(grid, tile)) return;
  for (TileKey key = leaf; key.level < tiling_.level_count(); key = tiling_.parent(key)) {
    const std::int64_t index = key.y * tiling_.tile_columns(key.level) + key.x;
    has_triangles_[static_cast<std::size_t>(key.level)][static_cast<std::size_t>(index)] = 1;
  }
}

void ValidDomain::note_line(const HeightGrid& grid, const Line& line) {
  if (line.at + 1 == (line.is_column ? tiling_.shape.columns : tiling_.shape.rows)) return;
  auto& steps = line.is_column ? columns_ : rows_;
  for (std::int64_t along = line.from; along < line.to; ++along) {
    steps[index_of(line, along)] = is_shared_step(grid, line, along);
  }
}

std::size_t ValidDomain::index_of(const Line& line, std::int64_t along) const {
  const std::int64_t length = line.is_column ? tiling_.shape.rows : tiling_.shape.columns;
  return static_cast<std::size_t>((line.at / tiling_.tile_cells - 1) * length + along);
}

bool ValidDomain::has_triangles(const TileKey& key) const {
  const std::int64_t index = key.y * tiling_.tile_columns(key.level) + key.x;
  return has_triangles_[static_cast<std::size_t>(key.level)][static_cast<std::size_t>(index)] != 0;
}

std::vector<Run> ValidDomain::shared_runs(const Line& line) const {
  const std::int64_t end = (line.is_column ? tiling_.shape.columns : tiling_.shape.rows) - 1;
  std::vector<Run> runs;
  if (line.at == 0 || line.at == end) return runs;
  const auto& steps = line.is_column ? columns_ : rows_;
  for (std::int64_t along = line.from; along < line.to; ++along) {
    if (!steps[index_of(line, along)]) continue;
    if (runs.empty() || runs.back().second != along) runs.emplace_back(along, along);
    runs.back().second = along + 1;
  }
  return runs;
}

}  // namespace terrane::verify

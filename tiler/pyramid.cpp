#include "tiler/pyramid.h"

#include <fmt/format.h>

#include <algorithm>

namespace terrane::tiler {

std::string path_of(const TileId& tile) {
  return fmt::format("{}/{}/{}", tile.level, tile.x, tile.y);
}

Pyramid::Pyramid(GridShape shape, std::int64_t tile_cells, int levels_per_octave, bool goes_round)
    : shape_(shape),
      tile_cells_(tile_cells),
      levels_per_octave_(levels_per_octave),
      goes_round_(goes_round) {
  while (cells_per_side(root_level()) < std::max(shape.columns, shape.rows) - 1) {
    level_count_ += levels_per_octave;
  }
}

std::vector<TileId> Pyramid::tiles(int level) const {
  std::vector<TileId> result;
  for (std::int64_t y = 0; holds({level, 0, y}); ++y) {
    for (std::int64_t x = 0; holds({level, x, y}); ++x) result.push_back({level, x, y});
  }
  return result;
}

std::vector<TileId> Pyramid::children(const TileId& tile) const {
  if (tile.level == 0) return {};
  if (!doubles_above(tile.level - 1)) return {{tile.level - 1, tile.x, tile.y}};
  std::vector<TileId> result;
  for (const std::int64_t y : {2 * tile.y, 2 * tile.y + 1}) {
    for (const std::int64_t x : {2 * tile.x, 2 * tile.x + 1}) {
      const TileId child{tile.level - 1, x, y};
      if (holds(child)) result.push_back(child);
    }
  }
  return result;
}

TileId Pyramid::parent(const TileId& tile) const {
  if (!doubles_above(tile.level)) return {tile.level + 1, tile.x, tile.y};
  return {tile.level + 1, tile.x / 2, tile.y / 2};
}

bool Pyramid::holds(const TileId& tile) const {
  const std::int64_t side = cells_per_side(tile.level);
  return tile.x * side < shape_.columns - 1 && tile.y * side < shape_.rows - 1;
}

Window Pyramid::window(const TileId& tile) const { return window(tile, 0); }

Window Pyramid::window(const TileId& tile, std::int64_t margin) const {
  const std::int64_t side = cells_per_side(tile.level);
  const std::int64_t left = std::max<std::int64_t>(0, tile.x * side - margin);
  const std::int64_t top = std::max<std::int64_t>(0, tile.y * side - margin);
  const std::int64_t right = std::min(shape_.columns - 1, (tile.x + 1) * side + margin);
  const std::int64_t bottom = std::min(shape_.rows - 1, (tile.y + 1) * side + margin);
  return {left, top, right - left + 1, bottom - top + 1};
}

bool Pyramid::is_on_seam(const TileId& tile, double column, double row) const {
  const Window own = window(tile);
  const auto left = static_cast<double>(own.column), top = static_cast<double>(own.row);
  const auto right = static_cast<double>(own.column + own.columns - 1);
  const auto bottom = static_cast<double>(own.row + own.rows - 1);
  const auto last_column = static_cast<double>(shape_.columns - 1);
  const auto last_row = static_cast<double>(shape_.rows - 1);
  if (goes_round_ && (column == 0 || column == last_column)) return true;
  return (column == left && column > 0) || (column == right && right < last_column) ||
         (row == top && row > 0) || (row == bottom && bottom < last_row);
}

}  // namespace terrane::tiler

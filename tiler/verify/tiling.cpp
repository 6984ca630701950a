#include "tiler/verify/tiling.h"

#include <fmt/format.h>

#include <algorithm>

namespace terrane::verify {
namespace {

std::int64_t tiles_along(std::int64_t samples, std::int64_t cells) {
  return (samples - 1 + cells - 1) / cells;
}

}  // namespace

std::string to_string(const TileKey& key) {
  return fmt::format("tile {}/{}/{}", key.level, key.x, key.y);
}

int Tiling::level_count() const {
  int level = 0;
  while (tile_columns(level) > 1 || tile_rows(level) > 1) ++level;
  return level + 1;
}

std::int64_t Tiling::tile_columns(int level) const {
  return tiles_along(shape.columns, tile_cells << octave(level));
}

std::int64_t Tiling::tile_rows(int level) const {
  return tiles_along(shape.rows, tile_cells << octave(level));
}

bool Tiling::has(const TileKey& key) const {
  return key.level >= 0 && key.level < level_count() && key.x >= 0 && key.y >= 0 &&
         key.x < tile_columns(key.level) && key.y < tile_rows(key.level);
}

Window Tiling::window(const TileKey& key) const {
  const std::int64_t cells = tile_cells << octave(key.level);
  Window window{.column = key.x * cells, .row = key.y * cells};
  window.columns = std::min(cells + 1, shape.columns - window.column);
  window.rows = std::min(cells + 1, shape.rows - window.row);
  return window;
}

std::vector<TileKey> Tiling::children(const TileKey& key) const {
  std::vector<TileKey> children;
  if (key.level == 0) return children;
  if (octave(key.level - 1) == octave(key.level)) return {{key.level - 1, key.x, key.y}};
  for (int child = 0; child < 4; ++child) {
    const TileKey candidate{key.level - 1, 2 * key.x + child % 2, 2 * key.y + child / 2};
    if (has(candidate)) children.push_back(candidate);
  }
  return children;
}

std::vector<TileKey> Tiling::subtree(const TileKey& key) const {
  std::vector<TileKey> keys;
  for (const TileKey& child : children(key)) {
    const std::vector<TileKey> below = subtree(child);
    keys.insert(keys.end(), below.begin(), below.end());
  }
  keys.push_back(key);
  return keys;
}

TileKey Tiling::parent(const TileKey& key) const {
  const int shift = octave(key.level + 1) - octave(key.level);
  return {key.level + 1, key.x >> shift, key.y >> shift};
}

TileKey Tiling::above(const TileKey& leaf, int level) const {
  return {level, leaf.x >> octave(level), leaf.y >> octave(level)};
}

bool Tiling::is_on_side(const TileKey& child, Side side) const {
  if (octave(child.level + 1) == octave(child.level)) return true;
  switch (side) {
    case Side::kWest:
      return child.x % 2 == 0;
    case Side::kEast:
      return child.x % 2 == 1;
    case Side::kNorth:
      return child.y % 2 == 0;
    case Side::kSouth:
      break;
  }
  return child.y % 2 == 1;
}

Side opposite(Side side) {
  switch (side) {
    case Side::kWest:
      return Side::kEast;
    case Side::kEast:
      return Side::kWest;
    case Side::kNorth:
      return Side::kSouth;
    case Side::kSouth:
      break;
  }
  return Side::kNorth;
}

TileKey neighbour(const TileKey& key, Side side) {
  switch (side) {
    case Side::kWest:
      return {key.level, key.x - 1, key.y};
    case Side::kEast:
      return {key.level, key.x + 1, key.y};
    case Side::kNorth:
      return {key.level, key.x, key.y - 1};
    case Side::kSouth:
      break;
  }
  return {key.level, key.x, key.y + 1};
}

Window with_ring(const Window& window, const GridShape& shape) {
  const std::int64_t column = std::max<std::int64_t>(window.column - 1, 0);
  const std::int64_t row = std::max<std::int64_t>(window.row - 1, 0);
  const std::int64_t end_column = std::min(window.column + window.columns + 1, shape.columns);
  const std::int64_t end_row = std::min(window.row + window.rows + 1, shape.rows);
  return {column, row, end_column - column, end_row - row};
}

}  // namespace terrane::verify

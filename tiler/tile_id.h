#pragma once

#include <compare>
#include <cstdint>
#include <string>

namespace terrane::tiler {

/// A tile of the native quadtree. Level 0 is the finest; x grows with the columns, y with the rows.
/// Pyramid knows its parent and children.
struct TileId {
  int level = 0;
  std::int64_t x = 0;
  std::int64_t y = 0;

  auto operator<=>(const TileId&) const = default;
};

/// "level/x/y", the place of a tile in folders and messages.
std::string path_of(const TileId& tile);

}  // namespace terrane::tiler

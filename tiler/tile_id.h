#pragma once

#include <compare>
#include <cstdint>
#include <string>

namespace terrane::tiler {

/// A tile of the native quadtree. Level 0 is the finest; x grows with the columns, y with the rows.
struct TileId {
  int level = 0;
  std::int64_t x = 0;
  std::int64_t y = 0;

  auto operator<=>(const TileId&) const = default;

  TileId parent() const { return {level + 1, x / 2, y / 2}; }
  /// \param quadrant  0 ... 3: (0,0), (1,0), (0,1), (1,1).
  TileId child(int quadrant) const {
    return {level - 1, 2 * x + quadrant % 2, 2 * y + quadrant / 2};
  }
};

/// "level/x/y", the place of a tile in folders and messages.
std::string path_of(const TileId& tile);

}  // namespace terrane::tiler

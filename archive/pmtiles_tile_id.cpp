#include "archive/pmtiles_tile_id.h"

#include <utility>

namespace terrane::archive {
namespace {

/// Turns a quadrant of the curve into the standard one, or back: a reflection undoes itself.
void turn(std::uint32_t size, std::uint32_t& x, std::uint32_t& y, std::uint32_t right,
          std::uint32_t upper) {
  if (upper != 0) return;
  if (right != 0) {
    x = size - 1 - x;
    y = size - 1 - y;
  }
  std::swap(x, y);
}

}  // namespace

std::uint64_t first_id_of_zoom(int zoom) {
  // (4^zoom - 1) / 3; at zoom 32, 4^32 - 1 is what a subtraction from 0 gives
  const std::uint64_t tiles = zoom < 32 ? std::uint64_t{1} << (2 * zoom) : 0;
  return (tiles - 1) / 3;
}

std::uint64_t tile_id_of(const ZoomTile& tile) {
  std::uint64_t along = 0;
  std::uint32_t x = tile.x;
  std::uint32_t y = tile.y;
  for (int bit = tile.zoom - 1; bit >= 0; --bit) {
    const std::uint32_t size = std::uint32_t{1} << bit;
    const std::uint32_t right = (x >> bit) & 1;
    const std::uint32_t upper = (y >> bit) & 1;
    along += (std::uint64_t{size} * size) * ((3 * right) ^ upper);
    x &= size - 1;
    y &= size - 1;
    turn(size, x, y, right, upper);
  }
  return first_id_of_zoom(tile.zoom) + along;
}

ZoomTile tile_at(std::uint64_t id) {
  ZoomTile tile;
  while (tile.zoom < kLargestZoom && first_id_of_zoom(tile.zoom + 1) <= id) ++tile.zoom;
  std::uint64_t along = id - first_id_of_zoom(tile.zoom);
  for (int bit = 0; bit < tile.zoom; ++bit, along >>= 2) {
    const std::uint32_t size = std::uint32_t{1} << bit;
    const auto right = static_cast<std::uint32_t>(along >> 1) & 1;
    const auto upper = static_cast<std::uint32_t>(along ^ right) & 1;
    turn(size, tile.x, tile.y, right, upper);
    tile.x += size * right;
    tile.y += size * upper;
  }
  return tile;
}

}  // namespace terrane::archive

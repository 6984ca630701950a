#pragma once

#include <cstdint>

namespace terrane::archive {

/// A tile of a quadtree: zoom 0 has one, x and y are below 2^zoom.
struct ZoomTile {
  int zoom = 0;
  std::uint32_t x = 0;
  std::uint32_t y = 0;

  auto operator<=>(const ZoomTile&) const = default;
};

inline constexpr int kLargestZoom = 31;

/// The place of a tile in the order of PMTiles: all tiles of lower zooms first, those of a zoom
/// along the Hilbert curve.
///
/// \pre 0 <= zoom <= kLargestZoom and x, y < 2^zoom.
/// \par Source
/// PMTiles version 3 specification, chapter 4.1; the curve of D. Hilbert (1891).
std::uint64_t tile_id_of(const ZoomTile& tile);

/// The tile at a place.
/// \pre id is below the first one of zoom kLargestZoom + 1.
ZoomTile tile_at(std::uint64_t id);

/// The first id of a zoom, and so the number of tiles below it.
/// \pre 0 <= zoom <= kLargestZoom + 1
std::uint64_t first_id_of_zoom(int zoom);

}  // namespace terrane::archive

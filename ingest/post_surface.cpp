#include "ingest/post_surface.h"

#include <algorithm>
#include <cmath>

namespace terrane::ingest {

PlaceOnSurface on_surface(double column, double row, std::int64_t rows) {
  PlaceOnSurface place{
      static_cast<std::int64_t>(std::floor(column)),
      std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(row)), 0, rows - 2)};
  const double x = column - static_cast<double>(place.column);
  const double y = std::clamp(row - static_cast<double>(place.row), 0.0, 1.0);
  constexpr std::int64_t kLast = kGeodeticTileCells - 1;
  const std::int64_t in_tile_x =
      (place.column % kGeodeticTileCells + kGeodeticTileCells) % kGeodeticTileCells;
  const std::int64_t in_tile_y = place.row % kGeodeticTileCells;
  const bool is_corner =
      (in_tile_x == kLast && in_tile_y == 0) || (in_tile_x == 0 && in_tile_y == kLast);
  if (is_corner) {
    place.share =
        x + y <= 1 ? std::array{1 - x - y, y, 0.0, x} : std::array{0.0, 1 - x, x + y - 1, 1 - y};
  } else {
    place.share = y >= x ? std::array{1 - y, y - x, x, 0.0} : std::array{1 - x, 0.0, y, x - y};
  }
  return place;
}

}  // namespace terrane::ingest

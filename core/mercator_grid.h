#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/georeference.h"

namespace terrane {

/// One zoom of the web mercator pyramid (EPSG:3857): 2^zoom x 2^zoom square tiles of pixels round
/// the Earth and to 85.05 degrees north and south. Tiles and pixels are counted eastward from 180 W
/// and southward (XYZ).
struct MercatorZoom {
  int zoom = 0;
  int tile_px = 256;

  std::int64_t tiles_across() const { return std::int64_t{1} << zoom; }
  double pixels_across() const { return std::ldexp(static_cast<double>(tile_px), zoom); }

  /// Place of a position in pixels; (0, 0) is the upper left corner of the first one, so that its
  /// middle is at (0.5, 0.5).
  LonLat at(double column, double row) const {
    const double angle = std::numbers::pi * (1 - 2 * row / pixels_across());
    return {column / pixels_across() * 360 - 180,
            std::atan(std::sinh(angle)) * 180 / std::numbers::pi};
  }
  double column_of(double longitude_deg) const {
    return (longitude_deg + 180) / 360 * pixels_across();
  }
  /// \pre the latitude is not that of a pole.
  double row_of(double latitude_deg) const {
    const double angle = std::asinh(std::tan(latitude_deg * std::numbers::pi / 180));
    return (1 - angle / std::numbers::pi) / 2 * pixels_across();
  }
};

/// A rectangle of tiles of one zoom; x may go on beyond the last tile, round the Earth.
struct MercatorTiles {
  int zoom = 0;
  std::int64_t x = 0, y = 0;
  std::int64_t columns = 0, rows = 0;

  bool operator==(const MercatorTiles&) const = default;

  /// The tiles that cover these at a zoom that is coarser, or the same.
  MercatorTiles at(int coarser) const {
    const int shift = zoom - coarser;
    const std::int64_t left = x >> shift, top = y >> shift;
    return {coarser, left, top, ((x + columns - 1) >> shift) - left + 1,
            ((y + rows - 1) >> shift) - top + 1};
  }
};

/// Heights at the pixels of the finest zoom of a web mercator pyramid.
class MercatorHeights {
 public:
  virtual ~MercatorHeights() = default;

  virtual int tile_px() const = 0;

  /// Tiles that hold something.
  virtual MercatorTiles tiles() const = 0;

  /// Metres at the middles of a tile's pixels, row by row; NaN where there is no data.
  /// \pre the tile is one of tiles().
  /// \throws InputError if they cannot be read.
  virtual std::vector<float> read(std::int64_t x, std::int64_t y) const = 0;
};

}  // namespace terrane

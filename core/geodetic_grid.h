#pragma once

#include <cmath>
#include <cstdint>

#include "core/georeference.h"
#include "core/height_grid.h"
#include "core/loose_samples.h"

namespace terrane {

/// Cells along a tile of the geodetic quadtree.
inline constexpr std::int64_t kGeodeticTileCells = 64;

/// The posts of one zoom of the geodetic quadtree (EPSG:4326, two square tiles of 180 degrees at
/// zoom 0, the next zoom halves them): kGeodeticTileCells cells a tile, a post on every border.
///
/// Posts are counted eastward from 180 W, beyond 360 degrees where a data set crosses that
/// meridian, and southward from the north pole.
struct GeodeticZoom {
  int zoom = 0;

  std::int64_t tiles_around() const { return std::int64_t{2} << zoom; }
  std::int64_t tiles_down() const { return std::int64_t{1} << zoom; }
  double tile_deg() const { return std::ldexp(180.0, -zoom); }
  double cell_deg() const { return tile_deg() / static_cast<double>(kGeodeticTileCells); }

  LonLat at(GridPosition post) const {
    return {std::remainder(-180 + post.column * cell_deg(), 360.0), 90 - post.row * cell_deg()};
  }
};

/// A rectangle of tiles of one zoom: x eastward from 180 W (beyond the last one: round the Earth),
/// y southward from the north pole.
struct GeodeticTiles {
  int zoom = 0;
  std::int64_t x = 0, y = 0;
  std::int64_t columns = 0, rows = 0;

  bool operator==(const GeodeticTiles&) const = default;

  /// The tiles that cover these at a zoom that is coarser, or the same.
  GeodeticTiles at(int coarser) const {
    const int shift = zoom - coarser;
    const std::int64_t left = x >> shift, top = y >> shift;
    return {coarser, left, top, ((x + columns - 1) >> shift) - left + 1,
            ((y + rows - 1) >> shift) - top + 1};
  }
  /// All the tiles of a finer zoom that they are made of.
  GeodeticTiles refined(int finer) const {
    const int shift = finer - zoom;
    return {finer, x << shift, y << shift, columns << shift, rows << shift};
  }
  Window posts() const {
    return {x * kGeodeticTileCells, y * kGeodeticTileCells, columns * kGeodeticTileCells + 1,
            rows * kGeodeticTileCells + 1};
  }
};

/// Heights over the WGS84 ellipsoid at the posts of every zoom up to the finest. There is a height
/// everywhere on Earth.
class GeodeticHeights {
 public:
  virtual ~GeodeticHeights() = default;

  /// The tiles of the finest zoom that the DEM reaches.
  virtual GeodeticTiles tiles() const = 0;

  /// Heights of posts in metres; never NaN. Posts of a coarser zoom are among those of the finer.
  ///
  /// Thread-safe. The same post gives the same bits at every call.
  /// \throws InputError if the heights cannot be read.
  virtual HeightGrid read(int zoom, const Window& posts) const = 0;

  /// The samples of the DEM that the heights were made from, counted in posts of the finest zoom:
  /// those from the window's first column and row to its last ones, in a fixed order.
  ///
  /// Thread-safe.
  /// \throws InputError if they cannot be read.
  virtual std::vector<LooseSample> dem_samples(const Window& posts) const = 0;

  /// Bounds of all heights.
  virtual double min_height_m() const = 0;
  virtual double max_height_m() const = 0;
};

}  // namespace terrane

#pragma once

#include <string>

#include "core/geodetic_grid.h"
#include "core/georeference.h"
#include "core/height_source.h"
#include "tiler/tile_id.h"

namespace terrane::tiler {

/// Some tiles of one zoom as a DEM of their own: what the level loop builds on.
///
/// Columns and rows count from the posts of the tiles' north-west corner. The loose samples between
/// them are those of the DEM.
class TileBand final : public HeightSource, public Georeference, public LooseSamples {
 public:
  /// \param heights  must outlive the band.
  TileBand(const GeodeticHeights& heights, const GeodeticTiles& tiles)
      : heights_(heights), tiles_(tiles) {}

  GridShape shape() const override;
  HeightGrid read(const Window& window) const override;

  /// \pre the tiles are of the finest zoom.
  std::vector<LooseSample> in(const Window& window) const override;

  const std::string& crs_wkt() const override;
  PlanPosition to_plan(GridPosition position) const override;
  std::vector<LonLat> to_lon_lat(std::span<const GridPosition> positions) const override;

  const GeodeticTiles& tiles() const { return tiles_; }

 private:
  const GeodeticHeights& heights_;
  GeodeticTiles tiles_;
};

/// A tile as its clients name it: zoom, x eastward from 180 W, y northward from the south pole.
struct TmsTile {
  int zoom = 0;
  std::int64_t x = 0, y = 0;

  auto operator<=>(const TmsTile&) const = default;
};

/// "zoom/x/y"
std::string path_of(const TmsTile& tile);

/// Degrees of a tile's borders.
struct TmsBounds {
  double west_deg, south_deg, east_deg, north_deg;
};
TmsBounds bounds_of(const TmsTile& tile);

/// What a tile of the band's level loop is for clients: level 0 is the band's own zoom.
TmsTile tms_of(const TileId& tile, const GeodeticTiles& band);

}  // namespace terrane::tiler

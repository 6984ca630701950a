#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/geodetic_grid.h"
#include "tiler/geodetic/tile_band.h"

namespace terrane::tiler {

/// What layer.json says of a set of terrain tiles.
struct TerrainLayer {
  std::string version;  ///< clients that keep tiles ask anew when it changes
  std::string attribution;
  std::vector<GeodeticTiles> available;  ///< by zoom, from 0
  bool has_water = false;
};

/// West, south, east and north of tiles in degrees; all longitudes where they cross 180 degrees, as
/// there are no bounds that clients agree on.
std::array<double, 4> bounds_deg(const GeodeticTiles& tiles);

/// layer.json as CesiumJS reads it: TMS, EPSG:4326, quantized-mesh 1.0.
///
/// The bounds are those of the finest tiles; both root tiles are listed.
std::string layer_json(const TerrainLayer& layer);

/// The metadata of a tile: which tiles there are below it, down to kMetadataZooms farther. Empty
/// for tiles whose zoom is not a multiple of that; CesiumJS asks those that are.
inline constexpr int kMetadataZooms = 10;
std::string tile_metadata(const TmsTile& tile, const std::vector<GeodeticTiles>& available);

}  // namespace terrane::tiler

#pragma once

#include <string>

#include "tiler/geodetic/terrain_tile.h"

namespace terrane::tiler {

/// Encodes a tile as the glb that CesiumJS reads as terrain: one mesh with one primitive, positions
/// and normals as floats from the middle of its bounding sphere, whose place is the matrix of the
/// only node, and the border vertices in CESIUM_tile_edges. Clients hang skirts from those.
///
/// Floats are as exact as 2^-24 of the tile's size.
/// \par Source
/// CesiumJS 1.140, Cesium3DTilesTerrainGeometryProcessor (experimental; there is no specification).
std::string encode_terrain_glb(const TerrainTile& tile, const std::string& attribution);

}  // namespace terrane::tiler

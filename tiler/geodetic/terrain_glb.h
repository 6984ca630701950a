#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tiler/geodetic/terrain_tile.h"

namespace terrane::tiler {

/// Encodes a tile as the glb that CesiumJS reads as terrain: one mesh with one primitive, positions
/// and normals as floats from the middle of its bounding sphere, whose place is the matrix of the
/// only node, and the border vertices in CESIUM_tile_edges. Clients hang skirts from those.
///
/// Guarantee: Earth-centred places, the middle's too, are whole multiples of \p step_m, so that
/// neighbours hold the same border vertices to the bit.
/// \param step_m  place_step_m() of the tile's zoom.
/// \par Source
/// CesiumJS 1.140, Cesium3DTilesTerrainGeometryProcessor (experimental; there is no specification).
std::string encode_terrain_glb(const TerrainTile& tile, double step_m,
                               const std::string& attribution);

/// The places that encode_terrain_glb() writes, Earth-centred.
std::vector<Eigen::Vector3d> glb_places_of(const TerrainTile& tile, double step_m);

/// The finest power of two of metres whose multiples floats hold all over any tile of a zoom: 2^-24
/// to 2^-23 of the tile's size.
double place_step_m(int zoom, double height_range_m);

}  // namespace terrane::tiler

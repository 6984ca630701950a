#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/geodetic_grid.h"
#include "tiler/geodetic/terrain_tile.h"
#include "tiler/tileset/write_tileset.h"

namespace terrane::tiler {

/// Error in metres that CesiumJS counts with for a tile of zoom 0 (a height map of 65 posts); it
/// halves with each zoom.
inline constexpr double kLevelZeroError_m = 77067.34;

/// "west/zoom/x/y.glb": below each of the two roots, x counts from the root's own border.
std::string glb_path_of(const TmsTile& tile);

/// The quadtree as 3D Tiles 1.1: tileset.json with the two roots, an implicit quadtree each, and
/// their subtrees with the facts of every tile, as CesiumJS's Cesium3DTilesTerrainProvider reads
/// them.
///
/// \param available  by zoom, from 0; both roots.
/// \param facts      of a tile that is available.
std::vector<OutputFile> terrain_tileset(const std::vector<GeodeticTiles>& available,
                                        const std::string& attribution,
                                        const std::function<TerrainFacts(const TmsTile&)>& facts);

}  // namespace terrane::tiler

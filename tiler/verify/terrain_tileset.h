#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tiler/verify/subtree.h"
#include "tiler/verify/terrain_layer.h"

namespace terrane::verify {

/// What tileset.json and the subtrees of 3D Tiles terrain say.
struct TerrainTileset {
  std::vector<ZoomRanges> available;            ///< by zoom, from 0
  std::map<TerrainKey, TerrainFacts> facts;     ///< of each tile
  std::array<std::string, 2> content_template;  ///< of the western and of the eastern root
  std::vector<std::string> faults;              ///< a line each: what CesiumJS would not take
};

/// Follows both roots through all subtrees.
/// \throws InputError that names the file if one is missing or damaged.
/// \par Source
/// OGC 3D Tiles 1.1, "Implicit Tiling"; CesiumJS 1.140, Cesium3DTilesTerrainProvider.
TerrainTileset read_terrain_tileset(const std::filesystem::path& folder);

/// A template with a tile's numbers, x counted from the root's western border.
std::string address_of(const std::string& address_template, const TerrainKey& key);

}  // namespace terrane::verify

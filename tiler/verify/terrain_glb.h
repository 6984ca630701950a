#pragma once

#include <filesystem>

#include "tiler/verify/subtree.h"
#include "tiler/verify/terrain_file.h"
#include "tiler/verify/terrain_layer.h"

namespace terrane::verify {

/// Reads a tile of 3D Tiles terrain as CesiumJS does: one mesh with one primitive,
/// CESIUM_tile_edges, the only node's matrix. Where a vertex is listed on a border, it counts as on
/// it.
///
/// At a pole all longitudes are the same place: u of vertices there is the middle of that of their
/// neighbours, and good for nothing but finding triangles.
///
/// \param facts  what the metadata say of it.
/// \throws InputError that names the file if it is missing or damaged.
TerrainFile read_terrain_glb(const std::filesystem::path& file, const TerrainKey& key,
                             const TerrainFacts& facts);

/// Is this side of a tile a pole?
bool is_pole(const TerrainKey& key, TerrainFile::Side side);

}  // namespace terrane::verify

#pragma once

#include <cstdint>
#include <string>

#include "tiler/geodetic/terrain_tile.h"

namespace terrane::tiler {

/// Minimum and maximum of a tile, and the number of its steps (a power of two) that make one
/// quantized step: decoders that interpolate between the two meet every height exactly.
struct HeightRange {
  float min_m = 0, max_m = 0;
  std::int64_t lowest = 0;    ///< in steps
  std::int64_t per_step = 1;  ///< quantized steps to one step
};
HeightRange height_range(const TerrainTile& tile);

/// Encodes a tile as quantized-mesh 1.0 with the extensions for normals and, if there are any,
/// water and metadata. Not compressed.
///
/// \pre every triangle has an area; u and v are from 0 to 32767.
/// \par Source
/// https://github.com/CesiumGS/quantized-mesh
std::string encode_quantized_mesh(const TerrainTile& tile);

}  // namespace terrane::tiler

#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tiler/tile_id.h"

namespace terrane::tiler {

/// How the buffers of a glb are stored.
enum class Compression {
  kMeshopt,  ///< EXT_meshopt_compression
  kDraco,    ///< KHR_draco_mesh_compression, without loss; no morph target, _MORPH alone
  kNone,
};

/// What a vertex position is in a glb.
enum class Positions {
  kLattice,  ///< whole steps, 16 bits where they fit (KHR_mesh_quantization); the node scales them
  kMetres,   ///< floats, the same places to the bit; no extension is needed
};

enum class Material {
  kLit,
  kUnlit,  ///< KHR_materials_unlit: shows texture or colours as they are
};

/// Vertex colours.
enum class Colour {
  kNone,
  kHypsometric,  ///< by height, from the lowest sample of the DEM to the highest
  kSlope,        ///< by steepness
};

/// Everything about how tiles are written, and nothing that decides their shape.
struct TileFormat {
  bool is_implicit = false;  ///< implicit tiling with subtrees, else explicit tilesets
  /// Tiles above which an explicit tree is split into external tilesets, 1 or more.
  std::int64_t tiles_per_tileset = 1000;
  Compression compression = Compression::kMeshopt;
  Positions positions = Positions::kLattice;
  Material material = Material::kLit;
  Colour colour = Colour::kNone;
  /// Depth of skirts in metres, 0: five times the tolerance of the level. Without: none.
  std::optional<double> skirt_m;
  /// Texels along a tile with a texture, 16 to 4096.
  int texture_px = 256;
  std::string attribution;  ///< who made the data; clients show it. May be empty
};

/// Where the glb of a tile lies in an output.
/// \param root_level  of the data set.
std::string glb_path(const TileFormat& format, const TileId& tile, int root_level);

/// What a format adds to the key of a data set: two formats with the same text write the same.
std::string key_of(const TileFormat& format);

/// \throws ConfigError that names the setting, if one is out of range.
void check(const TileFormat& format);

}  // namespace terrane::tiler

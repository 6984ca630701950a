#pragma once

#include <span>
#include <string>

#include "core/height_statistics.h"
#include "core/lattice_point.h"
#include "tiler/gltf/cut_texture.h"
#include "tiler/gltf/tile_skirt.h"
#include "tiler/tile/tile_mesh.h"
#include "tiler/tile_format.h"
#include "tiler/tile_id.h"

namespace terrane::tiler {

/// A tile that is ready to be written.
struct GlbTile {
  TileId id;
  const TileMesh& mesh;
  std::span<const LatticePoint> targets;  ///< of each vertex at t = 1, in steps of its own level
  TileSkirt skirt;                        ///< may be empty
  Eigen::Vector3d step_m;                 ///< east, north, up steps of the tile's level
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< upright in its middle
  bool is_mirrored = false;  ///< the grid runs clockwise in the world: triangles are turned
  double tolerance_m = 0;
  double max_error_m = 0;    ///< at least its children's
  HeightStatistics heights;  ///< of the DEM, for colours
  TileTexture texture;       ///< may be empty
};

/// Encodes a tile as a binary glTF as docs/formats.md describes it.
///
/// \pre the tile has triangles; positions and displacements fit 24 bits.
/// \throws OutputError if they do not (the lattice was chosen too fine).
std::string encode_glb(const GlbTile& tile, const TileFormat& format);

}  // namespace terrane::tiler

#pragma once

#include <span>
#include <string>

#include "core/lattice_point.h"
#include "tiler/tile_id.h"
#include "tiler/tile_mesh.h"

namespace terrane::tiler {

/// Encodes a tile as a binary glTF as docs/formats.md describes it.
///
/// \param targets      place of each vertex at t = 1, in steps of the tile's own level.
/// \param step_m       east, north, up steps of the tile's level.
/// \param is_mirrored  the grid runs clockwise in the world: triangles are turned.
/// \pre the tile has triangles; positions and displacements fit 24 bits.
/// \throws OutputError if they do not (the lattice was chosen too fine).
std::string encode_glb(const TileId& tile, const TileMesh& mesh,
                       std::span<const LatticePoint> targets, const Eigen::Vector3d& step_m,
                       bool is_mirrored);

}  // namespace terrane::tiler

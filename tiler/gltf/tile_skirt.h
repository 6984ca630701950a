#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/lattice_point.h"
#include "tiler/pyramid.h"
#include "tiler/tile/tile_mesh.h"

namespace terrane::tiler {

/// A curtain below the borders that a tile shares with neighbours, for clients that show
/// neighbours of different levels without blending them. No part of the measured mesh.
struct TileSkirt {
  std::vector<std::uint32_t> above;           ///< the tile's vertex over each point
  std::vector<LatticePoint> points;           ///< of the tile's border, and below them
  std::vector<LatticePoint> targets;          ///< at t = 1
  std::vector<hierarchy::Corners> triangles;  ///< turned outward
  std::vector<std::uint8_t> in_water;         ///< of each triangle; empty: none hangs from water
};

/// \param targets     of the tile's vertices at t = 1.
/// \param down_steps  from the border to the hem, in lattice steps.
TileSkirt hang_skirt(const Pyramid& pyramid, const TileId& tile, const TileMesh& mesh,
                     std::span<const LatticePoint> targets, const Eigen::Vector3d& down_steps);

}  // namespace terrane::tiler

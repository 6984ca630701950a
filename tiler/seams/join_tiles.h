#pragma once

#include <vector>

#include "core/lattice_point.h"
#include "hierarchy/mesh/halfedge_mesh.h"
#include "tiler/tile/tile_mesh.h"

namespace terrane::tiler {

/// Tiles of one level joined: one vertex where their borders meet.
struct JoinedTiles {
  std::vector<LatticePoint> points;                ///< on the lattice of the tiles' level
  std::vector<hierarchy::BorderPlace> borders;     ///< none inside the tiles
  std::vector<float> water_m;                      ///< NaN on land
  std::vector<hierarchy::Corners> triangles;       ///< tile by tile
  std::vector<std::uint8_t> in_water;              ///< of each triangle; empty: none is
  std::vector<hierarchy::LineEdge> lines;          ///< each once
  std::vector<std::vector<std::uint32_t>> number;  ///< for each tile, for each of its vertices
};

/// Joins tiles along the places on borders that they share.
JoinedTiles join(const std::vector<TileMesh>& tiles);

}  // namespace terrane::tiler

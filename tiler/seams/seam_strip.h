#pragma once

#include <cstdint>
#include <vector>

#include "core/lattice_point.h"
#include "hierarchy/mesh/halfedge_mesh.h"
#include "tiler/build_tile.h"
#include "tiler/seams/seam.h"

namespace terrane::tiler {

/// The triangles that touch a seam, of both its tiles.
struct Strip {
  std::vector<hierarchy::BorderPlace>
      borders;                         ///< of each vertex; none inside the tiles, but at level 0
  std::vector<double> line_heights_m;  ///< at level 0: of each vertex between samples; else NaN
  std::vector<LatticePoint> points;    ///< on the finer level's lattice; empty at level 0
  std::vector<hierarchy::Corners> triangles;
  std::vector<std::uint8_t> is_on_line;  ///< of each vertex
};

/// A strip and the samples that its triangles may cover.
struct StripOnGrid {
  Strip strip;    ///< without triangles where both tiles have none
  Window window;  ///< in samples of the DEM; of no meaning without triangles
};

/// The strip of a seam of level 0: of the full resolution, with the cells along the seam.
/// \throws InputError if the DEM cannot be read.
StripOnGrid leaf_strip(const TileSource& source, const SeamId& seam);

/// The strip of a seam of a higher level.
/// \param beside  the tiles of the finer level that reach the seam, from both sides.
StripOnGrid parent_strip(const TileSource& source, const SeamId& seam,
                         const std::vector<TileMesh>& beside);

/// Is a place on a border within a window, its rim included?
bool contains(const Window& window, const hierarchy::BorderPlace& place);

}  // namespace terrane::tiler

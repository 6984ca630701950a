#pragma once

#include <vector>

#include "tiler/build_tile.h"
#include "tiler/seams/seam.h"

namespace terrane::tiler {

/// Thins out a seam of level 0, from the samples beside it.
SeamChain build_leaf_seam(const TileSource& source, const SeamId& seam, double tolerance_m);

/// Thins out a seam of a higher level.
///
/// Leaves out what both tiles can do without: the triangles around the seam remain within the
/// tolerance of every sample in the world, and so does the blend into them.
/// \param beside  the tiles of the finer level that reach the seam, from both sides.
SeamChain build_parent_seam(const TileSource& source, const SeamId& seam,
                            const std::vector<TileMesh>& beside, double tolerance_m);

/// The children of both tiles of a seam that reach it.
std::vector<TileId> tiles_beside(const Pyramid& pyramid, const SeamId& seam);

}  // namespace terrane::tiler

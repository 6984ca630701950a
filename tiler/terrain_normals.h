#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/height_grid.h"
#include "hierarchy/collapse/terrain_mesh.h"
#include "tiler/tile_frame.h"

namespace terrane::tiler {

/// Samples on each side that the slope at a vertex is taken over: as wide as the level is coarse.
std::int64_t normal_reach(int level);

/// Normals of the terrain itself (not of the mesh), so that both sides of a seam agree.
///
/// \param window  the tile's samples; \p grid should reach normal_reach(level) beyond where it can.
/// \return one unit vector in the world for each place.
std::vector<Eigen::Vector3f> terrain_normals(std::span<const hierarchy::Place> places,
                                             const TileFrame& frame, int level,
                                             const HeightGrid& grid, const Window& window);

}  // namespace terrane::tiler

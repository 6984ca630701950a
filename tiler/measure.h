#pragma once

#include <span>

#include "core/height_grid.h"
#include "hierarchy/collapse/terrain_mesh.h"
#include "tiler/tile_frame.h"
#include "tiler/tile_mesh.h"

namespace terrane::tiler {

/// Measures a mesh as it is written, in the world, along the plumb line of every sample under it.
///
/// \param places  where the vertices stand over the grid of the tile.
/// \param points  the same as they are written, on the lattice of \p level.
/// \param window  the tile's samples; inside grid.window.
MeasuredError measure(std::span<const hierarchy::Place> places,
                      std::span<const hierarchy::Corners> triangles, const TileFrame& frame,
                      const Lattice& lattice, int level, const HeightGrid& grid,
                      const Window& window);

}  // namespace terrane::tiler

#pragma once

#include <span>
#include <utility>

#include "core/height_grid.h"
#include "hierarchy/collapse/terrain_mesh.h"
#include "tiler/tile_frame.h"
#include "tiler/tile_mesh.h"

namespace terrane::tiler {

/// Two vertices.
using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Measures a mesh as it is written, in the world, along the plumb line of every sample under it.
///
/// A sample that rounding left outside by less than a lattice step is measured against the nearest
/// point of the rim.
///
/// max_m is an upper bound: what the frame may be off is added.
/// \param rim     edges with a triangle on one side only.
/// \param places  where the vertices stand over the grid of the tile.
/// \param points  the same as they are written, on the lattice of \p level.
/// \param window  the tile's samples; inside grid.window.
MeasuredError measure(std::span<const hierarchy::Place> places,
                      std::span<const hierarchy::Corners> triangles, std::span<const Edge> rim,
                      const TileFrame& frame,
                      const Lattice& lattice, int level, const HeightGrid& grid,
                      const Window& window);

}  // namespace terrane::tiler

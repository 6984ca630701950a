#pragma once

#include <Eigen/Core>
#include <span>
#include <utility>

#include "core/height_grid.h"
#include "hierarchy/collapse/sample_field.h"
#include "hierarchy/mesh/halfedge_mesh.h"
#include "tiler/tile_frame.h"
#include "tiler/tile_mesh.h"

namespace terrane::tiler {

/// A vertex as it is written, or on its way between two levels.
struct WorldVertex {
  hierarchy::FieldPoint plan;  ///< where it stands over the tile's grid; the height is not used
  Eigen::Vector3d world;
};

/// Two vertices.
using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Measures a mesh in the world, along the plumb line of every sample under it.
///
/// A sample that rounding left outside by less than \p step_m is measured against the nearest point
/// of the rim. max_m is an upper bound: what the frame may be off is added.
/// \param rim     edges with a triangle on one side only.
/// \param window  the tile's samples; inside grid.window.
MeasuredError measure(std::span<const WorldVertex> vertices,
                      std::span<const hierarchy::Corners> triangles, std::span<const Edge> rim,
                      const TileFrame& frame, double step_m, const HeightGrid& grid,
                      const Window& window);

}  // namespace terrane::tiler

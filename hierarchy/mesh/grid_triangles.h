#pragma once

#include <cstdint>
#include <vector>

#include "core/height_grid.h"
#include "hierarchy/mesh/halfedge_mesh.h"

namespace terrane::hierarchy {

/// A sample of the DEM by column and row.
struct SampleId {
  std::int32_t column = -1;
  std::int32_t row = -1;

  bool operator==(const SampleId&) const = default;
};

/// A full-resolution mesh: its vertices are samples.
struct GridTriangles {
  std::vector<SampleId> vertices;  ///< row by row; only those that a triangle uses
  std::vector<Corners> triangles;  ///< indices into vertices; counter-clockwise with rows downward
};

/// Joins the samples of a window to triangles.
///
/// A cell with four heights gives two triangles, one with three gives one. Diagonals run from the
/// cell's first sample to its last, but in the corner cells of the window through the window's
/// corner: else a tile's two border edges there would share a triangle, and neither could give way.
/// \pre the window lies in grid.window.
GridTriangles triangulate(const HeightGrid& grid, const Window& window);

}  // namespace terrane::hierarchy

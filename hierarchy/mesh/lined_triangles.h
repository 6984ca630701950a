#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/grid_features.h"
#include "core/height_grid.h"
#include "hierarchy/mesh/border_place.h"
#include "hierarchy/mesh/grid_point.h"
#include "hierarchy/mesh/grid_triangles.h"

namespace terrane::hierarchy {

/// A vertex that a line brings into the full-resolution mesh.
struct LineVertex {
  GridPoint plan;
  double height_m = 0;
};

/// Two vertices that a line joins; the smaller number first.
using LineEdge = std::array<std::uint32_t, 2>;

/// The height of the water at a place of the DEM's grid that lies on no shore; nothing on land.
using WaterHeight = std::function<std::optional<double>(const GridPosition&)>;

/// A full-resolution mesh that holds lines as edges.
struct LinedTriangles {
  std::vector<SampleId> samples;          ///< the first vertices
  std::vector<LineVertex> line_vertices;  ///< the further ones
  std::vector<Corners> triangles;         ///< counter-clockwise in GridPoint's plane
  std::vector<LineEdge> edges;
};

/// Joins the samples of a window to triangles, as triangulate() does, and splits the cells that
/// lines pass through so that the lines are edges.
///
/// The triangles of a cell depend on what lines do in and on it alone; on the border of the window
/// also lines beside it count, so that two windows that share a border have the same vertices
/// there.
///
/// Every sample stays a vertex, so the mesh is as near to the samples as the one without lines is.
/// Where a line crosses a side of a cell, its vertex is as high as that side; where it bends
/// inside, as high as the triangle there; on a shore and in water, as high as the water. Lines end
/// where there is no triangle: with a vertex on the edge of the data that is no sample.
///
/// \param lines  pieces beside the window do no harm.
/// \param water  where there is some between the samples; none: shores alone are as high as water.
/// \pre the window lies in grid.window; lines are laid on the grid (core/grid_features.h).
LinedTriangles triangulate_with_lines(const HeightGrid& grid, const Window& window,
                                      std::span<const FeatureLine> lines,
                                      const WaterHeight& water = {});

/// Where the vertices stand on the grid of the DEM.
std::vector<BorderPlace> places_of(const LinedTriangles& full, const Window& window);

}  // namespace terrane::hierarchy

#pragma once

#include <cstdint>

#include "core/height_grid.h"
#include "core/height_source.h"
#include "hierarchy/collapse/terrain_mesh.h"

namespace terrane::tiler {

/// How far a mesh is from the samples of its grid, and whether it lies over them as terrain does.
struct GridError {
  double max_m = 0;            ///< largest vertical distance to a sample
  double rms_m = 0;            ///< root mean square over the covered samples
  std::int64_t samples = 0;    ///< with data, under at least one triangle
  std::int64_t uncovered = 0;  ///< with data, under no triangle
  std::int64_t folded = 0;     ///< triangles without area in plan, or turned over
};

/// Measures the vertical distance of a mesh to every sample, over the flat grid.
///
/// Exact: whether a sample lies under a triangle is decided in integers, so that none is missed on
/// an edge. A sample under several triangles counts once, with the largest distance.
///
/// \param mesh  plan is counted from sample (0, 0) of the DEM.
/// \param grid  NaN is no sample.
/// \pre the mesh spans at most kMostCells (tiler/dem_size.h) a side.
GridError measure_over_grid(const hierarchy::TerrainMesh& mesh, const HeightGrid& grid);

/// The same over a whole DEM, of which a strip of rows is in memory at a time.
/// \throws InputError if it cannot be read.
GridError measure_over_dem(const hierarchy::TerrainMesh& mesh, const HeightSource& heights,
                           std::int64_t samples_at_once = 16 << 20);

}  // namespace terrane::tiler

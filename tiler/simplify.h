#pragma once

#include "core/grid_features.h"
#include "core/height_source.h"
#include "core/progress.h"
#include "hierarchy/collapse/terrain_mesh.h"
#include "tiler/tile/grid_error.h"

namespace terrane::tiler {

struct SimplifyOptions {
  /// Largest vertical distance to any sample, in metres; above 0.
  double tolerance_m = 1;
  /// 0 to 3: more rounds of polish make fewer triangles; see hierarchy/collapse/strict_collapse.h.
  int effort = 1;
  /// Heights are written as whole multiples of 1 / height_steps_per_m metres.
  double height_steps_per_m = 1e6;
  /// Lines that stay edges of the mesh, within tolerance_m of their place in plan.
  GridFeatures features;
  /// Samples up to which the DEM is done at once, for the fewest triangles; a larger one is done in
  /// tiles (simplify_tiles.h). About 330 bytes a sample make 8 GB.
  std::int64_t most_samples_at_once = 25'000'000;
};

/// One mesh over a whole DEM, without tiles and levels.
struct SimplifiedTerrain {
  hierarchy::TerrainMesh mesh;  ///< plan in cells from the DEM's first sample; heights in metres
  std::int64_t input_triangles = 0;
  GridError error;  ///< of mesh, measured anew over every sample
};

/// \throws ConfigError that names the setting, if one is out of range.
void check(const SimplifyOptions& options);

/// Simplifies a DEM to one mesh that stays within the tolerance of every sample.
///
/// The distance is vertical, over the flat grid of the DEM: the Earth's curvature, which matters
/// only to a mesh drawn on the globe, is not in it. The mesh covers every sample that the
/// full-resolution triangulation (hierarchy/mesh/grid_triangles.h) covers, and is nowhere folded.
/// The result depends on the heights and options alone.
///
/// \throws ConfigError if an option is out of range, or the tolerance is finer than the heights are
///         written; InputError if the DEM has no triangle, is too large (check_size() in
///         tiler/dem_size.h), or cannot be read.
SimplifiedTerrain simplify(const HeightSource& heights, const SimplifyOptions& options,
                           Progress& progress);

}  // namespace terrane::tiler

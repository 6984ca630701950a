#pragma once

#include <Eigen/Core>
#include <span>
#include <utility>
#include <vector>

#include "core/height_grid.h"
#include "hierarchy/collapse/sample_field.h"
#include "hierarchy/mesh/halfedge_mesh.h"
#include "tiler/tile/tile_frame.h"
#include "tiler/tile/tile_mesh.h"
#include "tiler/tile/tile_samples.h"

namespace terrane::tiler {

/// A vertex as it is written, or on its way between two levels.
struct WorldVertex {
  hierarchy::FieldPoint plan;  ///< where it stands over the tile's grid; the height is not used
  Eigen::Vector3d world;
};

/// Two vertices.
using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// A mesh to be measured.
struct MeasuredMesh {
  std::vector<WorldVertex> vertices;
  std::span<const hierarchy::Corners> triangles;
  std::vector<Edge> rim;  ///< edges with a triangle on one side only
};

struct Measured {
  std::vector<MeasuredError> errors;               ///< one for each mesh
  std::vector<hierarchy::FieldSample> noted = {};  ///< heights over the frame's curved datum
};

/// Measures meshes over one tile in the world, along the plumb line of every sample under them, the
/// loose ones as well.
///
/// A sample that rounding left outside by less than \p step_m is measured against the nearest point
/// of the rim. max_m is an upper bound: what the frame may be off is added.
/// \param noted_m  samples that any mesh is farther from than this are noted.
Measured measure(std::span<const MeasuredMesh> meshes, const TileSamples& samples,
                 const TileFrame& frame, double step_m, double noted_m);

}  // namespace terrane::tiler

#pragma once

#include <span>
#include <vector>

#include "hierarchy/collapse/sample_field.h"
#include "hierarchy/collapse/terrain_mesh.h"
#include "tiler/tile/tile_frame.h"
#include "tiler/tile/tile_samples.h"

namespace terrane::tiler {

/// A level on its way to the coarser one: each vertex on a straight line.
struct Blend {
  std::span<const hierarchy::Place> from;
  std::span<const hierarchy::Place> to;  ///< one for each of from
  std::span<const hierarchy::Corners> triangles;
};

/// The samples of the grid that a blend is too far from at some t, judged as collapses are
/// (moving_triangle.h), against every sample, patch by patch.
///
/// For those who were held against a reduced reference: what it leaves out, they have not met.
/// \param slack_cells  see SampleField.
/// \return empty if all hold at all t; else those, and the ones beyond kNotedShare of the tolerance
///         under the same triangles; heights over the frame's curved datum.
std::vector<hierarchy::FieldSample> samples_left_by(const Blend& blend, const TileSamples& samples,
                                                    const TileFrame& frame, double slack_cells,
                                                    double tolerance_m);

}  // namespace terrane::tiler

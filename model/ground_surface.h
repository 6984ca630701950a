#pragma once

#include <string>
#include <vector>

#include "core/progress.h"
#include "hierarchy/volume/interface_surface.h"
#include "ingest/dem.h"
#include "model/plan_frame.h"

namespace terrane::model {

/// Triangles over the samples of DEMs, some cells beyond a box on all sides.
///
/// The vertices are the samples of the first DEM, never resampled. Where it has no data, or has
/// ended, its grid goes on and takes the height from the next DEM that has one: bilinear, and where
/// samples around are void the mean of the nearest ones, up to 8 cells away (their number goes to
/// progress.note()).
///
/// \param dems  at least one, in the order of their right to speak.
/// \throws InputError naming the first DEM and a place, if none has a height there.
hierarchy::volume::SurfaceMesh ground_surface(const std::vector<const ingest::Dem*>& dems,
                                              const PlanFrame& frame,
                                              const hierarchy::volume::Box& box,
                                              Progress& progress);

}  // namespace terrane::model

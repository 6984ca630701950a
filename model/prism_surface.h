#pragma once

#include <string>

#include "hierarchy/volume/interface_surface.h"
#include "ingest/read_polygon.h"
#include "model/plan_frame.h"

namespace terrane::model {

/// A closed surface around a body of water: flat at a level inside polygons, upright walls along
/// their rings, and a bottom below the box. What lies under the ground is hidden by the ground.
///
/// \param name  of the polygons' file, for messages.
/// \throws InputError if polygons cross themselves or each other (says where), or the file's places
///         and the frame's are of different kinds.
hierarchy::volume::SurfaceMesh prism_surface(const std::string& name,
                                             const ingest::PolygonFile& polygons, double level,
                                             const PlanFrame& frame,
                                             const hierarchy::volume::Box& box);

}  // namespace terrane::model

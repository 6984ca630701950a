#pragma once

#include <memory>
#include <string>

#include "core/progress.h"
#include "hierarchy/volume/field.h"
#include "hierarchy/volume/tetra_mesh.h"
#include "model/model_file.h"
#include "model/plan_frame.h"

namespace terrane::model {

/// A field from a raster with one band for each of some heights, trilinear in between and level
/// beyond its ends; with one band and no heights it is the same at every height.
///
/// Posts are the raster's samples (cell centres) where its rows and columns run along the model's
/// axes: a raster without CRS and rotation. Else, posts stand in rows along the model's axes, as many
/// as the raster has cells there, and take bilinear values of the samples around. Values are
/// what the file means (scale and offset applied), as floats.
///
/// \param name  of the field, for messages.
/// \throws InputError naming field and file, if it cannot be read, has not one band for each level,
///         lies outside the box, or holds no data (or NaN) at a place that the box needs; if levels
///         do not rise.
std::shared_ptr<const hierarchy::volume::Field> raster_field(const std::string& name,
                                                             const FieldSource& source,
                                                             const PlanFrame& frame,
                                                             const hierarchy::volume::Box& box,
                                                             Progress& progress);

}  // namespace terrane::model

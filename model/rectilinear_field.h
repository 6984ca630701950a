#pragma once

#include <memory>
#include <string>

#include "core/progress.h"
#include "hierarchy/volume/field.h"
#include "hierarchy/volume/tetra_mesh.h"
#include "model/model_file.h"

namespace terrane::model {

/// A field from a VTK rectilinear grid (.vtr), trilinear between its posts and level beyond its
/// ends. Its coordinates are metres of the model; posts that the box does not need are left out.
///
/// \param name  of the field, for messages.
/// \throws InputError naming field and file, if the file cannot be read, an axis does not rise, the
///         grid lies outside the box, or a value that the box needs is no number.
std::shared_ptr<const hierarchy::volume::Field> rectilinear_field(
    const std::string& name, const FieldSource& source, const hierarchy::volume::Box& box,
    Progress& progress);

}  // namespace terrane::model

#pragma once

#include <array>
#include <memory>
#include <string>

#include "hierarchy/volume/grid_field.h"
#include "hierarchy/volume/tetra_mesh.h"

namespace terrane::model {

/// A field given by a formula of x, y and z (metres of the model), sampled on a grid over the box. The field is the trilinear function through the samples: a formula without
/// squares of a coordinate is met exactly by two samples along each axis.
///
/// \param formula  in muParser's language ("2700 - 0.1 * z"); empty: 0.
/// \param samples  along each axis, 2 to 1000.
/// \throws ConfigError if a formula cannot be read, or samples are out of range; InputError if it
///         has no value at a sample.
std::shared_ptr<const hierarchy::volume::Field> formula_field(
    const std::string& name, const std::string& formula, const hierarchy::volume::Box& box,
    const std::array<int, 3>& samples);

}  // namespace terrane::model

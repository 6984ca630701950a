#pragma once

#include "core/progress.h"
#include "hierarchy/volume/material_volume.h"
#include "model/model_file.h"

namespace terrane::model {

/// What a model file describes, ready to be refined.
struct Model {
  hierarchy::volume::VolumeModel volume;
  hierarchy::volume::VolumeTolerances tolerances;
  bool is_on_earth = false;
  double longitude_deg = 0, latitude_deg = 0;  ///< x = y = 0 of the model, on Earth
};

/// Reads the surfaces, and makes materials and fields.
///
/// On Earth the model's x and y are metres east and north of the middle of the box (transverse
/// Mercator, scale 1 along its meridian), else those of the DEMs' plan. Heights are as in the
/// files.
///
/// \throws InputError naming file or surface for what cannot be used: files that cannot be read,
///         open or self-intersecting meshes, DEMs without data in the box, a surface under the one
///         that it is said to lie over by more than both tolerances, a field with NaN, without data in the box or
///         beside it.
/// \throws ConfigError for names that are not known, or formulas that cannot be read.
Model build_model(const ModelSettings& settings, Progress& progress);

}  // namespace terrane::model

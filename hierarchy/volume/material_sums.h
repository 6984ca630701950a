#pragma once

#include <vector>

#include "hierarchy/volume/material_volume.h"

namespace terrane::hierarchy::volume {

/// What there is of a material.
struct MaterialSum {
  double volume = 0;             ///< cubic units of the model
  std::vector<double> integral;  ///< of each field over the material: its unit times that of volume
};

/// Sums over the approximation, exact but for rounding; one entry for each material.
std::vector<MaterialSum> sum_materials(const MaterialVolume& volume);

}  // namespace terrane::hierarchy::volume

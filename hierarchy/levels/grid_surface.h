#pragma once

#include "core/height_grid.h"
#include "hierarchy/levels/surface_mesh.h"

namespace terrane::hierarchy {

/// The full-resolution mesh of a DEM: every sample that a triangle touches is a vertex.
///
/// x runs along the columns and y against the rows, in metres from the first sample; z is height.
/// \param column_spacing_m, row_spacing_m  distance of neighbouring samples, above 0.
SurfaceMesh surface_of(const HeightGrid& grid, double column_spacing_m, double row_spacing_m);

}  // namespace terrane::hierarchy

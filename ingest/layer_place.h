#pragma once

#include <ogr_geometry.h>

#include "core/georeference.h"
#include "core/height_grid.h"
#include "ingest/vector_layer.h"

namespace terrane::ingest {

/// Moves the parts of a layer from its CRS onto the grid of a DEM, in cells, and cuts off what lies
/// beside it by more than a few cells.
///
/// \throws InputError if one of the two has no CRS and the other has, the layer's CRS has no place
/// on
///         Earth, or nothing is left.
void place_on_grid(VectorLayer& layer, const Georeference& place, GridShape shape);

/// Moves the parts of a layer from its CRS to longitudes and latitudes.
/// \throws InputError if the layer has no CRS, or one without a place on Earth.
void place_on_earth(VectorLayer& layer);

/// Largest distances of two neighbouring samples of a row and of a column, in metres.
struct GridSpacing {
  double column_m, row_m;
};
GridSpacing largest_spacing(const Georeference& place, GridShape shape);

}  // namespace terrane::ingest

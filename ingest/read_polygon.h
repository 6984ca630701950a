#pragma once

#include <string>
#include <vector>

#include "core/georeference.h"

namespace terrane::ingest {

/// An area with holes. Rings are closed without repeating their first point; either turn.
struct Polygon {
  std::vector<PlanPosition> outline;
  std::vector<std::vector<PlanPosition>> holes;
};

/// The polygons of a vector file.
struct PolygonFile {
  std::vector<Polygon> polygons;  ///< at least one
  /// Places are longitudes (x) and latitudes (y) on WGS84 in degrees; else plain plan positions.
  bool is_geographic = false;
};

/// Reads all polygons and multi-polygons of the first layer, in any format of GDAL.
///
/// A layer with a CRS comes as longitudes and latitudes on WGS84, one without as it is.
/// \throws InputError if the file cannot be read, or holds no polygon.
PolygonFile read_polygons(const std::string& file);

/// Reads all polygons of one layer as they are, but for the way to longitudes and latitudes, which
/// is that of a DEM with the layer's CRS.
/// \param source  what GDAL opens as vectors, with ":LAYER" after it where it has several.
/// \throws InputError if it cannot be read, or holds other geometries.
PolygonFile read_layer_polygons(const std::string& source);

}  // namespace terrane::ingest

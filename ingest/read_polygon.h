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

}  // namespace terrane::ingest

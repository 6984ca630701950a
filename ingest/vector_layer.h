#pragma once

#include <ogr_geometry.h>
#include <ogr_spatialref.h>

#include <string>
#include <vector>

namespace terrane::ingest {

/// All geometries of one layer: plane, without curves and collections.
struct VectorLayer {
  std::string name;                         ///< as given, for messages
  OGRSpatialReference crs;                  ///< empty if the layer has none
  std::vector<OGRGeometryUniquePtr> parts;  ///< line strings and polygons
};

enum class WantedGeometry { kLines, kPolygons };

/// \param source  what GDAL opens as vectors, with ":LAYER" after it where it has several.
/// \throws InputError if it cannot be opened, a layer has to be named, or it holds nothing of the
///         wanted kind (kLines: lines or polygons), or anything of another.
VectorLayer read_vector_layer(const std::string& source, WantedGeometry wanted);

}  // namespace terrane::ingest

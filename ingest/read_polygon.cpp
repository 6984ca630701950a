#include "ingest/read_polygon.h"

#include <fmt/format.h>
#include <ogrsf_frmts.h>

#include <memory>

#include "core/errors.h"
#include "ingest/gdal_scope.h"
#include "ingest/layer_place.h"
#include "ingest/vector_layer.h"

namespace terrane::ingest {
namespace {

std::vector<PlanPosition> read_ring(const OGRLinearRing& ring) {
  std::vector<PlanPosition> points;
  for (int i = 0; i < ring.getNumPoints(); ++i) points.push_back({ring.getX(i), ring.getY(i)});
  const bool is_repeated = points.size() > 1 && points.front().x == points.back().x &&
                           points.front().y == points.back().y;
  if (is_repeated) points.pop_back();
  return points;
}

void collect(const OGRGeometry& geometry, std::vector<Polygon>& polygons) {
  const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
  if (type == wkbMultiPolygon) {
    for (const OGRPolygon* part : *geometry.toMultiPolygon()) collect(*part, polygons);
  }
  if (type != wkbPolygon || geometry.IsEmpty()) return;
  const OGRPolygon& source = *geometry.toPolygon();
  Polygon polygon{read_ring(*source.getExteriorRing()), {}};
  for (int i = 0; i < source.getNumInteriorRings(); ++i) {
    polygon.holes.push_back(read_ring(*source.getInteriorRing(i)));
  }
  polygons.push_back(std::move(polygon));
}

std::unique_ptr<OGRCoordinateTransformation> to_lon_lat(const OGRSpatialReference& crs) {
  OGRSpatialReference from(crs), wgs84;
  wgs84.importFromEPSG(4326);
  from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return std::unique_ptr<OGRCoordinateTransformation>(
      OGRCreateCoordinateTransformation(&from, &wgs84));
}

}  // namespace

PolygonFile read_polygons(const std::string& file) {
  const GdalScope gdal;
  const GDALDatasetUniquePtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR));
  if (dataset == nullptr || dataset->GetLayerCount() == 0) {
    throw InputError(
        fmt::format("{}: is no vector file that GDAL can read. Give a file with a "
                    "polygon (GeoPackage, GeoJSON, Shapefile)",
                    file));
  }
  OGRLayer* layer = dataset->GetLayer(0);
  const OGRSpatialReference* crs = layer->GetSpatialRef();
  const auto shift = crs != nullptr ? to_lon_lat(*crs) : nullptr;
  PolygonFile result;
  result.is_geographic = crs != nullptr;
  for (const OGRFeatureUniquePtr& feature : layer) {
    std::unique_ptr<OGRGeometry> geometry(feature->StealGeometry());
    if (geometry == nullptr) continue;
    if (crs != nullptr && (shift == nullptr || geometry->transform(shift.get()) != OGRERR_NONE)) {
      throw InputError(
          fmt::format("{}: its places cannot be turned into longitude and latitude. "
                      "Reproject it to EPSG:4326",
                      file));
    }
    collect(*geometry, result.polygons);
  }
  if (result.polygons.empty()) {
    throw InputError(fmt::format("{}: holds no polygon. Give the area as a polygon", file));
  }
  return result;
}

PolygonFile read_layer_polygons(const std::string& source) {
  VectorLayer layer = read_vector_layer(source, WantedGeometry::kPolygons);
  PolygonFile result;
  result.is_geographic = !layer.crs.IsEmpty();
  if (result.is_geographic) place_on_earth(layer);
  for (const OGRGeometryUniquePtr& part : layer.parts) collect(*part, result.polygons);
  return result;
}

}  // namespace terrane::ingest

#include "ingest/vector_layer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include "core/errors.h"
#include "ingest/gdal_scope.h"

namespace terrane::ingest {
namespace {

GDALDatasetUniquePtr open_vectors(const std::string& file) {
  return GDALDatasetUniquePtr(
      GDALDataset::Open(file.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY, nullptr, nullptr));
}

std::string layer_names(GDALDataset& dataset) {
  std::vector<std::string> names;
  for (OGRLayer* layer : dataset.GetLayers()) names.emplace_back(layer->GetName());
  return fmt::format("{}", fmt::join(names, ", "));
}

OGRLayer& only_layer(GDALDataset& dataset, const std::string& source) {
  if (dataset.GetLayerCount() == 1) return *dataset.GetLayer(0);
  throw InputError(fmt::format("{}: has {} layers ({}). Name one: {}:LAYER", source,
                               dataset.GetLayerCount(), layer_names(dataset), source));
}

OGRLayer& named_layer(GDALDataset& dataset, const std::string& file, const std::string& name) {
  if (OGRLayer* layer = dataset.GetLayerByName(name.c_str())) return *layer;
  throw InputError(
      fmt::format("{}: has no layer '{}'. It has {}", file, name, layer_names(dataset)));
}

/// Appends the lines and polygons that a geometry is made of.
void add_parts(const OGRGeometry& geometry, WantedGeometry wanted, VectorLayer& layer) {
  if (const auto* collection = dynamic_cast<const OGRGeometryCollection*>(&geometry)) {
    for (const OGRGeometry* part : *collection) add_parts(*part, wanted, layer);
    return;
  }
  const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
  const bool is_line = type == wkbLineString && wanted == WantedGeometry::kLines;
  if (!is_line && type != wkbPolygon) {
    throw InputError(fmt::format("{}: holds a {}. {}", layer.name, OGRGeometryTypeToName(type),
                                 wanted == WantedGeometry::kLines
                                     ? "Give a layer of lines or polygons"
                                     : "Water is given as polygons; lines go to --lines"));
  }
  if (geometry.IsEmpty()) return;
  layer.parts.emplace_back(geometry.clone());
  layer.parts.back()->flattenTo2D();
}

}  // namespace

VectorLayer read_vector_layer(const std::string& source, WantedGeometry wanted) {
  const GdalScope gdal;
  GDALDatasetUniquePtr dataset = open_vectors(source);
  OGRLayer* layer = dataset ? &only_layer(*dataset, source) : nullptr;
  const std::size_t colon = source.rfind(':');
  if (!dataset && colon != std::string::npos) {
    const std::string file = source.substr(0, colon);
    dataset = open_vectors(file);
    if (dataset) layer = &named_layer(*dataset, file, source.substr(colon + 1));
  }
  if (!dataset) {
    throw InputError(
        fmt::format("{}: cannot be opened as vectors ({}). Give a file that OGR reads, "
                    "like .gpkg, .shp or .geojson",
                    source, gdal.reason()));
  }
  VectorLayer result;
  result.name = source;
  if (const OGRSpatialReference* crs = layer->GetSpatialRef()) result.crs = *crs;
  for (const auto& feature : *layer) {
    const OGRGeometry* geometry = feature->GetGeometryRef();
    if (geometry == nullptr) continue;
    const OGRGeometryUniquePtr straight(geometry->getLinearGeometry());
    add_parts(*straight, wanted, result);
  }
  if (result.parts.empty()) {
    throw InputError(fmt::format("{}: holds no geometry. Give a layer with some", source));
  }
  return result;
}

}  // namespace terrane::ingest

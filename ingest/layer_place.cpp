#include "ingest/layer_place.h"

#include <cpl_conv.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/errors.h"
#include "ingest/datum_shift.h"
#include "ingest/gdal_scope.h"
#include "ingest/geographic_inverse.h"

namespace terrane::ingest {
namespace {

using Points = std::vector<PlanPosition>;
using Map = std::function<Points(const Points&)>;

/// Moves every point of a geometry.
class MovePoints final : public OGRDefaultGeometryVisitor {
 public:
  explicit MovePoints(const Map& map) : map_(map) {}

  using OGRDefaultGeometryVisitor::visit;
  void visit(OGRLineString* line) override { move(*line); }
  void visit(OGRLinearRing* ring) override { move(*ring); }

 private:
  void move(OGRSimpleCurve& curve) {
    Points points;
    for (int i = 0; i < curve.getNumPoints(); ++i) {
      points.push_back({curve.getX(i), curve.getY(i)});
    }
    points = map_(points);
    for (int i = 0; i < curve.getNumPoints(); ++i) curve.setPoint(i, points[i].x, points[i].y);
  }

  const Map& map_;
};

void move(VectorLayer& layer, const Map& map) {
  MovePoints visitor(map);
  for (const OGRGeometryUniquePtr& part : layer.parts) part->accept(&visitor);
}

Points positions_of(const VectorLayer& layer) {
  Points points;
  const Map collect = [&](const Points& some) {
    points.insert(points.end(), some.begin(), some.end());
    return some;
  };
  const VectorLayer& same = layer;
  MovePoints visitor(collect);
  for (const OGRGeometryUniquePtr& part : same.parts) part->accept(&visitor);
  return points;
}

OGRPolygon box(double left, double bottom, double right, double top) {
  OGRLinearRing ring;
  ring.addPoint(left, bottom);
  ring.addPoint(right, bottom);
  ring.addPoint(right, top);
  ring.addPoint(left, top);
  ring.closeRings();
  OGRPolygon polygon;
  polygon.addRing(&ring);
  return polygon;
}

/// Keeps what lies in the box; what is cut comes apart into lines and polygons again.
void clip(VectorLayer& layer, const OGRPolygon& to) {
  std::vector<OGRGeometryUniquePtr> kept;
  const std::function<void(const OGRGeometry&)> keep = [&](const OGRGeometry& geometry) {
    if (const auto* collection = dynamic_cast<const OGRGeometryCollection*>(&geometry)) {
      for (const OGRGeometry* part : *collection) keep(*part);
      return;
    }
    const OGRwkbGeometryType type = wkbFlatten(geometry.getGeometryType());
    if (type == wkbPoint || geometry.IsEmpty()) return;
    kept.emplace_back(geometry.clone());
  };
  for (const OGRGeometryUniquePtr& part : layer.parts) {
    const OGRGeometryUniquePtr inside(part->Intersection(&to));
    if (inside) keep(*inside);
  }
  layer.parts = std::move(kept);
}

/// Column and row of plan positions: the inverse of an affine map.
Map affine_inverse(const Georeference& place) {
  const PlanPosition o = place.to_plan({0, 0}), c = place.to_plan({1, 0}),
                     r = place.to_plan({0, 1});
  const double cx = c.x - o.x, cy = c.y - o.y, rx = r.x - o.x, ry = r.y - o.y;
  const double scale = 1 / (cx * ry - cy * rx);
  return [=](const Points& points) {
    Points result;
    for (const PlanPosition& p : points) {
      const double x = p.x - o.x, y = p.y - o.y;
      result.push_back({(x * ry - y * rx) * scale, (y * cx - x * cy) * scale});
    }
    return result;
  };
}

bool is_same_crs(const OGRSpatialReference& crs, const std::string& wkt) {
  OGRSpatialReference own;
  own.importFromWkt(wkt.c_str());
  const char* const options[] = {"IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES", nullptr};
  return own.IsSame(&crs, options) != 0;
}

std::string wkt_of(const OGRSpatialReference& crs) {
  const char* const options[] = {"FORMAT=WKT2_2019", "MULTILINE=NO", nullptr};
  char* text = nullptr;
  crs.exportToWkt(&text, options);
  std::string wkt = text == nullptr ? "" : text;
  CPLFree(text);
  return wkt;
}

/// The layer's own coordinates to longitude and latitude.
void to_lon_lat(VectorLayer& layer) {
  const std::vector<int>& mapping = layer.crs.GetDataAxisToSRSAxisMapping();
  const std::array axes =
      mapping.size() < 2 ? std::array{1, 2} : std::array{mapping[0], mapping[1]};
  layer.crs.StripVertical();
  layer.crs.DemoteTo2D(nullptr);
  const auto shift = DatumShift::find(wkt_of(layer.crs), axes, positions_of(layer));
  if (!shift) {
    throw InputError(
        fmt::format("{}: its CRS has no place on Earth. Reproject the layer with "
                    "ogr2ogr -t_srs EPSG:4326",
                    layer.name));
  }
  move(layer, [&](const Points& points) {
    Points result;
    for (const LonLat& at : shift->to_lon_lat(points)) {
      result.push_back({at.longitude_deg, at.latitude_deg});
    }
    return result;
  });
}

void refuse_beside(const VectorLayer& layer, const std::string& dem_area) {
  if (!layer.parts.empty()) return;
  throw InputError(
      fmt::format("{}: lies beside the DEM ({}). Check the CRS of both, or give a layer "
                  "of the same area",
                  layer.name, dem_area));
}

}  // namespace

void place_on_grid(VectorLayer& layer, const Georeference& place, GridShape shape) {
  const GdalScope gdal;
  const bool dem_has_crs = !place.crs_wkt().empty(), layer_has_crs = !layer.crs.IsEmpty();
  if (dem_has_crs != layer_has_crs) {
    throw InputError(fmt::format(
        "{}: {}. {}", layer.name,
        layer_has_crs ? "has a CRS, and the DEM has none" : "has no CRS, and the DEM has one",
        layer_has_crs ? "Name the DEM's with --crs"
                      : "Write it into the layer with ogr2ogr -a_srs"));
  }
  if (dem_has_crs && !is_same_crs(layer.crs, place.crs_wkt())) {
    const GeographicInverse inverse(place, shape);
    to_lon_lat(layer);
    move(layer, [&](const Points& points) {
      Points result;
      for (const PlanPosition& p : points) result.push_back({inverse.unwrapped(p.x), p.y});
      return result;
    });
    const GeographicArea& area = inverse.area();
    clip(layer, box(area.west_deg, area.south_deg, area.east_deg, area.north_deg));
    refuse_beside(layer, inverse.described());
    move(layer, [&](const Points& points) { return inverse.to_grid(points); });
  } else {
    move(layer, affine_inverse(place));
  }
  const auto columns = static_cast<double>(shape.columns), rows = static_cast<double>(shape.rows);
  constexpr double kMargin_cells = 2;
  clip(layer, box(-kMargin_cells, -kMargin_cells, columns + kMargin_cells, rows + kMargin_cells));
  refuse_beside(layer, fmt::format("{} x {} samples", shape.columns, shape.rows));
}

void place_on_earth(VectorLayer& layer) {
  const GdalScope gdal;
  if (layer.crs.IsEmpty()) {
    throw InputError(
        fmt::format("{}: has no CRS. Write it into the layer with ogr2ogr -a_srs", layer.name));
  }
  to_lon_lat(layer);
}

GridSpacing largest_spacing(const Georeference& place, GridShape shape) {
  const double last_column = static_cast<double>(shape.columns - 1);
  const double last_row = static_cast<double>(shape.rows - 1);
  std::vector<GridPosition> at;
  for (const double v : {0.0, 0.5, 1.0}) {
    for (const double u : {0.0, 0.5, 1.0}) {
      const double column = u * (last_column - 1), row = v * (last_row - 1);
      at.insert(at.end(), {{column, row}, {column + 1, row}, {column, row + 1}});
    }
  }
  const bool has_crs = !place.crs_wkt().empty();
  const std::vector<LonLat> places = has_crs ? place.to_lon_lat(at) : std::vector<LonLat>{};
  const auto distance_m = [&](std::size_t i, std::size_t j) {
    if (!has_crs) {
      const PlanPosition a = place.to_plan(at[i]), b = place.to_plan(at[j]);
      return std::hypot(b.x - a.x, b.y - a.y);
    }
    // WGS84's radii of curvature at the latitude: exact for the length of a cell
    constexpr double kEquator_m = 6378137, kSquaredEccentricity = 6.69437999014e-3;
    constexpr double kRadians = std::numbers::pi / 180;
    const double sine = std::sin(places[i].latitude_deg * kRadians);
    const double w2 = 1 - kSquaredEccentricity * sine * sine;
    const double across_m = kEquator_m / std::sqrt(w2);
    const double along_m = across_m * (1 - kSquaredEccentricity) / w2;
    const double east_deg =
        std::remainder(places[j].longitude_deg - places[i].longitude_deg, 360.0);
    const double north_deg = places[j].latitude_deg - places[i].latitude_deg;
    return kRadians * std::hypot(east_deg * across_m * std::cos(places[i].latitude_deg * kRadians),
                                 north_deg * along_m);
  };
  GridSpacing spacing{0, 0};
  for (std::size_t i = 0; i < at.size(); i += 3) {
    spacing.column_m = std::max(spacing.column_m, distance_m(i, i + 1));
    spacing.row_m = std::max(spacing.row_m, distance_m(i, i + 2));
  }
  return spacing;
}

}  // namespace terrane::ingest

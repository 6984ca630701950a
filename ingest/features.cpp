#include "ingest/features.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "ingest/gdal_scope.h"
#include "ingest/grid_line.h"
#include "ingest/layer_place.h"
#include "ingest/vector_layer.h"
#include "ingest/water_level.h"

namespace terrane::ingest {
namespace {

// of the tolerance in plan: what simplification before the mesh, and moving onto samples, may take
constexpr double kShareOfSimplification = 0.25;
constexpr double kShareOfSnapping = 0.125;
constexpr double kMostSnap_cells = 1.0 / 256;

/// How lines come onto the grid within their share of the tolerance.
struct Laying {
  double simplify_cells, snap_cells;

  std::vector<GridPosition> lay(const OGRSimpleCurve& curve) const {
    std::vector<GridPosition> points;
    for (int i = 0; i < curve.getNumPoints(); ++i) points.push_back({curve.getX(i), curve.getY(i)});
    return points.size() < 2 ? points : lay_on_grid(points, snap_cells);
  }

  OGRGeometryUniquePtr simplified(const OGRGeometry& geometry) const {
    OGRGeometryUniquePtr result(geometry.SimplifyPreserveTopology(simplify_cells));
    return result ? std::move(result) : OGRGeometryUniquePtr(geometry.clone());
  }
};

void add_line(const OGRSimpleCurve& curve, const Laying& laying, GridFeatures& features) {
  std::vector<GridPosition> points = laying.lay(curve);
  if (!points.empty()) features.lines.push_back({std::move(points), {}});
}

void add_lines(const VectorLayer& layer, const Laying& laying, GridFeatures& features) {
  for (const OGRGeometryUniquePtr& part : layer.parts) {
    const OGRGeometryUniquePtr simple = laying.simplified(*part);
    if (const auto* polygon = dynamic_cast<const OGRPolygon*>(simple.get())) {
      for (const OGRLinearRing* ring : *polygon) add_line(*ring, laying, features);
    } else if (const auto* line = dynamic_cast<const OGRLineString*>(simple.get())) {
      add_line(*line, laying, features);
    }
  }
}

std::vector<WaterBody> bodies_of(const VectorLayer& layer, const Laying& laying) {
  std::vector<WaterBody> bodies;
  for (const OGRGeometryUniquePtr& part : layer.parts) {
    const OGRGeometryUniquePtr simple = laying.simplified(*part);
    const auto* polygon = dynamic_cast<const OGRPolygon*>(simple.get());
    if (polygon == nullptr) continue;
    WaterBody body;
    for (const OGRLinearRing* ring : *polygon) {
      std::vector<GridPosition> shore = laying.lay(*ring);
      if (shore.size() >= 4) body.shores.push_back(std::move(shore));
    }
    if (!body.shores.empty()) bodies.push_back(std::move(body));
  }
  return bodies;
}

void set_height(WaterBody& body, const std::optional<double>& asked_m, const HeightSource& heights,
                const std::string& layer) {
  const std::optional<double> height_m = asked_m ? asked_m : shore_height_m(body, heights);
  if (!height_m) {
    throw InputError(
        fmt::format("{}: the DEM has no data along a shore, so the water's height is "
                    "not known. Give it with --water-height",
                    layer));
  }
  // what the heights of a DEM are: the shore is to be as high as the samples beside it
  body.height_m = static_cast<float>(*height_m);
}

}  // namespace

GridFeatures read_features(Dem& dem, const FeatureOptions& options, Progress& progress) {
  GridFeatures features;
  if (options.empty()) return features;
  const GdalScope gdal;
  const GridShape shape = dem.heights().shape();
  const GridSpacing spacing = largest_spacing(dem.place(), shape);
  features.column_m = spacing.column_m;
  features.row_m = spacing.row_m;
  const double larger_m = std::max(spacing.column_m, spacing.row_m);
  const double tolerance_cells = options.plan_tolerance_m / larger_m;
  const Laying laying{kShareOfSimplification * tolerance_cells,
                      std::min(kShareOfSnapping * tolerance_cells, kMostSnap_cells)};
  const double rounded_cells = laying.snap_cells + 0.5 / kLinePartsPerCell;
  features.off_plan_m = laying.simplify_cells * larger_m +
                        rounded_cells * std::hypot(spacing.column_m, spacing.row_m);

  std::vector<WaterBody> bodies;
  for (const std::string& source : options.water) {
    VectorLayer layer = read_vector_layer(source, WantedGeometry::kPolygons);
    place_on_grid(layer, dem.place(), shape);
    for (WaterBody& body : bodies_of(layer, laying)) {
      set_height(body, options.water_height_m, dem.heights(), source);
      for (const auto& shore : body.shores) features.lines.push_back({shore, body.height_m});
      progress.note(fmt::format("{}: water at {:.3f} m, {} shores", source, body.height_m,
                                body.shores.size()));
      bodies.push_back(std::move(body));
    }
  }
  for (const std::string& source : options.lines) {
    VectorLayer layer = read_vector_layer(source, WantedGeometry::kLines);
    place_on_grid(layer, dem.place(), shape);
    add_lines(layer, laying, features);
  }
  if (!bodies.empty()) dem.level_water(bodies);
  return features;
}

}  // namespace terrane::ingest

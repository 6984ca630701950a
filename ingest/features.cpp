#include "ingest/features.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "ingest/fingerprint.h"
#include "ingest/gdal_scope.h"
#include "ingest/grid_line.h"
#include "ingest/layer_place.h"
#include "ingest/separate_lines.h"
#include "ingest/vector_layer.h"
#include "ingest/water_level.h"

namespace terrane::ingest {
namespace {

// of the tolerance in plan: what simplification before the mesh, and moving onto samples, may take
constexpr double kShareOfSimplification = 0.25;
constexpr double kShareOfSnapping = 0.125;
constexpr double kMostSnap_cells = 1.0 / 256;

// where places are rounded: lines lie on parts of cells this wide, and stay apart by half of that.
// The lattice's steps are a sixteenth of the tolerance and 1/256 cell at most
// (tiler/build.cpp): two ends of an altitude together are rounded by 1.4 of them, and half a
// part is 2
constexpr double kShareOfSimplificationIfRounded = 0.125;
constexpr double kShareOfPart = 0.25;
constexpr int kFewestParts = 64;
constexpr int kMostParts = 4096;

/// How lines come onto the grid within their share of the tolerance.
struct Laying {
  double simplify_cells;
  LineRounding rounding;

  std::vector<GridPosition> lay(const OGRSimpleCurve& curve) const {
    std::vector<GridPosition> points;
    for (int i = 0; i < curve.getNumPoints(); ++i) points.push_back({curve.getX(i), curve.getY(i)});
    return points.size() < 2 ? points : lay_on_grid(points, rounding);
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

void set_height(WaterBody& body, const std::optional<double>& asked_m, const Dem& dem,
                const std::string& layer) {
  std::optional<double> height_m;
  if (asked_m) {
    // as users know it: over what the DEM's own heights are over
    height_m = *asked_m + dem.raised_m(body.shores.front());
  } else {
    height_m = shore_height_m(body, dem.heights());
  }
  if (!height_m) {
    throw InputError(
        fmt::format("{}: the DEM has no data along a shore, so the water's height is "
                    "not known. Give it with --water-height",
                    layer));
  }
  // what the heights of a DEM are: the shore is to be as high as the samples beside it
  body.height_m = static_cast<float>(*height_m);
}

/// Least distance of lines and samples: half of what places are apart.
double gap_m(const LineRounding& rounding, const GridFeatures& features) {
  return std::min(features.column_m / rounding.column_parts, features.row_m / rounding.row_parts) /
         2;
}

int parts_of(double cell_m, double tolerance_m) {
  const double parts = std::ceil(cell_m / (kShareOfPart * tolerance_m));
  return static_cast<int>(std::clamp<double>(parts, kFewestParts, kMostParts));
}

/// How lines are laid, and in \p features how far they come to lie off their place by that.
Laying laying_of(const FeatureOptions& options, GridFeatures& features) {
  const double column_m = features.column_m, row_m = features.row_m;
  const double larger_m = std::max(column_m, row_m);
  const double tolerance_cells = options.plan_tolerance_m / larger_m;
  if (!options.is_rounded) {
    const Laying laying{
        kShareOfSimplification * tolerance_cells,
        {.snap_cells = std::min(kShareOfSnapping * tolerance_cells, kMostSnap_cells)}};
    const double rounded_cells = laying.rounding.snap_cells + 0.5 / kLinePartsPerCell;
    features.off_plan_m =
        laying.simplify_cells * larger_m + rounded_cells * std::hypot(column_m, row_m);
    return laying;
  }
  const Laying laying{kShareOfSimplificationIfRounded * tolerance_cells,
                      {.column_parts = parts_of(column_m, options.plan_tolerance_m),
                       .row_parts = parts_of(row_m, options.plan_tolerance_m)}};
  features.off_plan_m =
      laying.simplify_cells * larger_m +
      std::hypot(column_m / laying.rounding.column_parts, row_m / laying.rounding.row_parts) / 2 +
      gap_m(laying.rounding, features);
  return laying;
}

void keep_apart(const Laying& laying, std::vector<WaterBody>& bodies, GridFeatures& features) {
  std::vector<std::vector<GridPosition>*> lines;
  for (WaterBody& body : bodies) {
    for (auto& shore : body.shores) lines.push_back(&shore);
  }
  for (FeatureLine& line : features.lines) lines.push_back(&line.points);
  separate_lines(lines, {features.column_m, features.row_m}, gap_m(laying.rounding, features));
}

std::string fingerprint_of(const GridFeatures& features) {
  Fingerprint fingerprint;
  for (const FeatureLine& line : features.lines) {
    fingerprint.add(static_cast<std::uint64_t>(line.points.size()));
    for (const GridPosition& p : line.points) {
      fingerprint.add(p.column);
      fingerprint.add(p.row);
    }
    fingerprint.add(line.height_m.value_or(NAN));
  }
  for (const std::size_t shores : features.shores) fingerprint.add(std::uint64_t{shores});
  for (const auto& [row, spans] : features.water) {
    for (const WaterSpan& span : spans) {
      for (const std::int64_t number : {row, span.first, span.last}) {
        fingerprint.add(static_cast<std::uint64_t>(number));
      }
      fingerprint.add(static_cast<double>(span.height_m));
    }
  }
  return fingerprint.hex();
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
  const Laying laying = laying_of(options, features);

  std::vector<WaterBody> bodies;
  for (const std::string& source : options.water) {
    VectorLayer layer = read_vector_layer(source, WantedGeometry::kPolygons);
    place_on_grid(layer, dem.place(), shape);
    for (WaterBody& body : bodies_of(layer, laying)) {
      set_height(body, options.water_height_m, dem, source);
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
  if (options.is_rounded) keep_apart(laying, bodies, features);
  std::vector<FeatureLine> shores;
  for (const WaterBody& body : bodies) {
    for (const auto& shore : body.shores) shores.push_back({shore, body.height_m});
    features.shores.push_back(body.shores.size());
  }
  features.lines.insert(features.lines.begin(), shores.begin(), shores.end());
  features.water = water_rows(bodies, shape);
  features.fingerprint = fingerprint_of(features);
  if (!bodies.empty()) dem.level_water(features.water);
  return features;
}

}  // namespace terrane::ingest

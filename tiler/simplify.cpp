#include "tiler/simplify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/errors.h"
#include "hierarchy/collapse/strict_collapse.h"
#include "hierarchy/mesh/boundary_vertices.h"
#include "hierarchy/mesh/grid_triangles.h"
#include "tiler/dem_size.h"
#include "tiler/simplify_tiles.h"
#include "tiler/tile/grid_census.h"
#include "tiler/tile/water_areas.h"

namespace terrane::tiler {
namespace {

using hierarchy::GridPoint;
using hierarchy::Place;
using hierarchy::SampleField;
using hierarchy::TerrainMesh;
using hierarchy::VertexKind;

// what the collapse and the measurement may differ by in rounding: 9 km take 10^-11 m in doubles
constexpr double kRounding_m = 1e-9;

/// Writes places over the flat grid itself: plan as it is, heights in steps.
class FlatPlacer final : public hierarchy::Placer {
 public:
  explicit FlatPlacer(double height_steps_per_m) : steps_per_m_(height_steps_per_m) {}

  Place place(GridPoint plan, double height_m) const override {
    const double steps = std::round(height_m * steps_per_m_);
    return {plan, steps / steps_per_m_, {plan.x, plan.y, static_cast<std::int64_t>(steps)}};
  }
  bool is_straight(const Place&, const Place&) const override { return true; }

 private:
  double steps_per_m_;
};

/// Can it be simplified at once?
bool is_small(GridShape shape, const SimplifyOptions& options) {
  return shape.columns * shape.rows <= options.most_samples_at_once;
}

SampleField field_of(const HeightGrid& grid) {
  SampleField field{grid.window.columns, grid.window.rows, {}};
  field.heights_m.assign(grid.heights_m.begin(), grid.heights_m.end());
  return field;
}

/// Every sample a vertex; those on the edge of the data are marked as outline, those on lines as
/// feature.
TerrainMesh full_terrain(const HeightGrid& grid, const GridFeatures& features,
                         const hierarchy::Placer& placer) {
  const WaterAreas areas(features);
  hierarchy::LinedTriangles full = hierarchy::triangulate_with_lines(
      grid, grid.window, features.lines,
      [&](const GridPosition& place) { return areas.height_m(place); });
  TerrainMesh terrain{{}, std::move(full.triangles), std::move(full.edges)};
  terrain.vertices.reserve(full.samples.size() + full.line_vertices.size());
  for (const hierarchy::SampleId& sample : full.samples) {
    const GridPoint plan{sample.column * hierarchy::kUnitsPerCell,
                         -sample.row * hierarchy::kUnitsPerCell};
    terrain.vertices.push_back({.place = placer.place(plan, grid.at(sample.column, sample.row))});
  }
  for (const hierarchy::LineVertex& vertex : full.line_vertices) {
    terrain.vertices.push_back({.place = placer.place(vertex.plan, vertex.height_m)});
  }
  for (const hierarchy::LineEdge& edge : terrain.lines) {
    for (const std::uint32_t v : edge) terrain.vertices[v].kind = VertexKind::kFeature;
  }
  const std::vector<bool> is_boundary =
      hierarchy::boundary_vertices(terrain.vertices.size(), terrain.triangles);
  for (std::uint32_t v = 0; v < terrain.vertices.size(); ++v) {
    if (!is_boundary[v]) continue;
    hierarchy::TerrainVertex& vertex = terrain.vertices[v];
    // where a line comes to the edge of the data, it stays
    const bool is_on_line = vertex.kind == VertexKind::kFeature;
    if (vertex.kind != VertexKind::kLocked) {
      vertex.kind = is_on_line ? VertexKind::kLocked : VertexKind::kOutline;
    }
    if (v < full.samples.size()) vertex.border = full.samples[v];
  }
  return terrain;
}

std::int64_t sample_count(const TerrainMesh& full) {
  return std::ranges::count_if(full.vertices, [](const hierarchy::TerrainVertex& vertex) {
    const GridPoint p = vertex.place.plan;
    return p.x % hierarchy::kUnitsPerCell == 0 && p.y % hierarchy::kUnitsPerCell == 0;
  });
}

/// What reading and rounding the lines have left of the tolerance.
hierarchy::LineTolerance line_tolerance(const SimplifyOptions& options) {
  const GridFeatures& features = options.features;
  return {std::max(0.0, options.tolerance_m - features.off_plan_m), features.column_m,
          features.row_m};
}

[[noreturn]] void refuse_empty() {
  throw InputError(
      "no three neighbouring samples of the DEM have data: there is no terrain. "
      "Check --nodata");
}

void judge(const GridError& error, std::int64_t samples, const SimplifyOptions& options) {
  if (error.samples != samples || error.folded > 0) {
    throw std::logic_error(fmt::format("{} of {} samples covered, {} triangles folded",
                                       error.samples, samples, error.folded));
  }
  if (error.max_m <= options.tolerance_m) return;
  throw ConfigError(
      fmt::format("--tolerance {}: cannot be kept where heights are written in steps of {} m (the "
                  "mesh is {:.3g} m off). Use a larger one, or write ply",
                  options.tolerance_m, 1 / options.height_steps_per_m, error.max_m));
}

SimplifiedTerrain simplify_at_once(const HeightSource& heights, const SimplifyOptions& options,
                                   double tolerance_m, Progress& progress) {
  const GridShape shape = heights.shape();
  const HeightGrid grid = heights.read({0, 0, shape.columns, shape.rows});
  const FlatPlacer placer(options.height_steps_per_m);
  const TerrainMesh full = full_terrain(grid, options.features, placer);
  if (full.triangles.empty()) refuse_empty();

  progress.begin("simplify", 1);
  SimplifiedTerrain result;
  result.input_triangles = std::ssize(full.triangles);
  const hierarchy::StrictOptions strict{
      .tolerance_m = tolerance_m, .effort = options.effort, .lines = line_tolerance(options)};
  result.mesh = hierarchy::collapse_strictly(full, field_of(grid), placer, {}, strict).mesh;
  result.error = measure_over_grid(result.mesh, grid);
  judge(result.error, sample_count(full), options);
  progress.advance(1);
  return result;
}

SimplifiedTerrain simplify_by_tiles(const HeightSource& heights, const SimplifyOptions& options,
                                    double tolerance_m, Progress& progress) {
  const GridCensus census = count_grid(heights);
  if (census.triangles == 0) refuse_empty();
  SimplifiedTerrain result;
  result.input_triangles = census.triangles;
  result.mesh = simplify_in_tiles(heights, options, tolerance_m, progress);
  result.error = measure_over_dem(result.mesh, heights);
  judge(result.error, census.samples, options);
  return result;
}

}  // namespace

void check(const SimplifyOptions& options) {
  if (!(options.tolerance_m > 0) || !std::isfinite(options.tolerance_m)) {
    throw ConfigError(
        fmt::format("--tolerance {}: must be a number of metres above 0", options.tolerance_m));
  }
  if (options.effort < 0 || options.effort > hierarchy::kTopEffort) {
    throw ConfigError(
        fmt::format("--effort {}: must be from 0 to {}", options.effort, hierarchy::kTopEffort));
  }
}

SimplifiedTerrain simplify(const HeightSource& heights, const SimplifyOptions& options,
                           Progress& progress) {
  check(options);
  check_size(heights.shape());
  const double wanted_m = std::max(options.tolerance_m - kRounding_m, options.tolerance_m / 2);
  return is_small(heights.shape(), options)
             ? simplify_at_once(heights, options, wanted_m, progress)
             : simplify_by_tiles(heights, options, wanted_m, progress);
}

}  // namespace terrane::tiler

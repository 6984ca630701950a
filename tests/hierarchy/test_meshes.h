#pragma once

#include <cstdint>
#include <vector>

#include "core/height_grid.h"
#include "hierarchy/collapse/sample_field.h"
#include "hierarchy/collapse/terrain_mesh.h"
#include "hierarchy/mesh/grid_triangles.h"

namespace terrane::hierarchy::testing {

/// A grid of heights from a function of column and row; NaN makes a hole.
template <class Height>
HeightGrid grid_of(std::int64_t columns, std::int64_t rows, Height height) {
  HeightGrid grid{{0, 0, columns, rows}, {}};
  for (std::int64_t row = 0; row < rows; ++row) {
    for (std::int64_t column = 0; column < columns; ++column) {
      grid.heights_m.push_back(static_cast<float>(height(column, row)));
    }
  }
  return grid;
}

inline std::vector<Corners> triangles_of(std::int64_t columns, std::int64_t rows) {
  const HeightGrid flat = grid_of(columns, rows, [](auto, auto) { return 0; });
  return triangulate(flat, flat.window).triangles;
}

inline SampleField field_of(const HeightGrid& grid) {
  return {grid.window.columns, grid.window.rows, {grid.heights_m.begin(), grid.heights_m.end()}};
}

/// Writes places as they are: no rounding but that of heights to 1/1024 m.
class ExactPlacer final : public Placer {
 public:
  Place place(GridPoint plan, double height_m) const override {
    const auto k = static_cast<std::int64_t>(height_m * 1024);
    return {plan, static_cast<double>(k) / 1024, {plan.x, plan.y, k}};
  }
  bool is_straight(const Place&, const Place&) const override { return true; }
};

/// A world in which a row of the grid is a parabola, bend * column^2 cells below its beginning: a
/// straight line of it passes bend * c^2 / 4 below the middle of a row's c cells.
class BentPlacer final : public Placer {
 public:
  explicit BentPlacer(double bend) : bend_(bend) {}

  Place place(GridPoint plan, double height_m) const override {
    return ExactPlacer().place(plan, height_m);
  }
  bool is_straight(const Place&, const Place&) const override { return false; }
  double longest_straight_units() const override { return kUnitsPerCell; }
  void look_down(std::span<const Place> places, std::span<PlanPoint> seen) const override {
    for (std::size_t k = 0; k < places.size(); ++k) {
      const double column = column_of(places[k].plan), row = row_of(places[k].plan);
      seen[k] = {kUnitsPerCell * column, -kUnitsPerCell * (row + bend_ * column * column)};
    }
  }

 private:
  double bend_;
};

/// The full-resolution mesh of a grid, its rim marked as outline.
inline TerrainMesh terrain_of(const HeightGrid& grid) {
  const GridTriangles full = triangulate(grid, grid.window);
  const HalfedgeMesh mesh(static_cast<std::uint32_t>(full.vertices.size()), full.triangles);
  TerrainMesh terrain{{}, full.triangles};
  for (std::uint32_t v = 0; v < full.vertices.size(); ++v) {
    const SampleId s = full.vertices[v];
    TerrainVertex vertex{ExactPlacer().place({s.column * kUnitsPerCell, -s.row * kUnitsPerCell},
                                             grid.at(s.column, s.row))};
    if (mesh.is_boundary(VertexId{v})) {
      vertex.kind = VertexKind::kOutline;
      vertex.border = s;
    }
    terrain.vertices.push_back(vertex);
  }
  return terrain;
}

}  // namespace terrane::hierarchy::testing

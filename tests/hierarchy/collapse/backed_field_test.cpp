// What a reduced field leaves out, if it is there as well.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "hierarchy/collapse/morph_guard.h"
#include "hierarchy/collapse/moving_triangle.h"
#include "hierarchy/collapse/star_error.h"
#include "hierarchy/collapse/strict_collapse.h"
#include "tests/hierarchy/test_meshes.h"

namespace terrane::hierarchy {
namespace {

using testing::ExactPlacer;
using testing::field_of;
using testing::grid_of;
using testing::terrain_of;

/// Hills, and a spike that no block keeps.
HeightGrid hills() {
  return grid_of(65, 65, [](auto c, auto r) {
    const double spike = c == 22 && r == 37 ? 9 : 0;
    return 8 * std::sin(0.2 * c) * std::cos(0.15 * r) + spike;
  });
}

enum class Behind { kNothing, kHeights, kSlabs, kBoth };

CodedHeights coded(const SampleField& field) {
  const auto [lowest, highest] = std::ranges::minmax(field.heights_m);
  CodedHeights heights({field.columns, field.rows}, lowest, highest);
  for (std::int64_t row = 0; row < field.rows; ++row) {
    for (std::int64_t column = 0; column < field.columns; ++column) {
      heights.set(column, row, field.row(row)[column]);
    }
  }
  return heights;
}

/// Keeps one sample of each block, and all behind it or not.
SampleField reduced(const HeightGrid& grid, Behind behind) {
  SampleField field = field_of(grid);
  std::vector<FieldSample> kept;
  for (std::int64_t row = 0; row < grid.window.rows; row += 8) {
    for (std::int64_t column = 0; column < grid.window.columns; column += 8) {
      kept.push_back({static_cast<float>(column), static_cast<float>(row), grid.at(column, row)});
    }
  }
  const bool has_heights = behind == Behind::kHeights || behind == Behind::kBoth;
  if (has_heights) field.behind = coded(field);
  if (behind == Behind::kSlabs) field.slabs = field.slabs_of_grid(2);
  field.keep(8, kept);
  if (behind == Behind::kBoth) field.slabs = field.slabs_of_grid(8);
  return field;
}

/// The largest distance of the mesh to a sample, asked triangle by triangle in barycentric
/// coordinates.
double error_m(const TerrainMesh& mesh, const HeightGrid& grid) {
  double worst_m = 0;
  for (const Corners& corners : mesh.triangles) {
    double x[3], y[3], z[3];
    for (int k = 0; k < 3; ++k) {
      const Place& place = mesh.vertices[corners[k]].place;
      x[k] = column_of(place.plan);
      y[k] = row_of(place.plan);
      z[k] = place.height_m;
    }
    const double area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    for (std::int64_t row = 0; row < grid.window.rows; ++row) {
      for (std::int64_t column = 0; column < grid.window.columns; ++column) {
        const double w1 = ((column - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (row - y[0])) / area;
        const double w2 = ((x[1] - x[0]) * (row - y[0]) - (column - x[0]) * (y[1] - y[0])) / area;
        if (w1 < 0 || w2 < 0 || w1 + w2 > 1) continue;
        const double on_mesh_m = z[0] + w1 * (z[1] - z[0]) + w2 * (z[2] - z[0]);
        worst_m = std::max(worst_m, std::abs(on_mesh_m - grid.at(column, row)));
      }
    }
  }
  return worst_m;
}

StrictResult collapse(const HeightGrid& grid, Behind behind) {
  const ExactPlacer placer;
  const SampleField field = reduced(grid, behind);
  return collapse_strictly(terrain_of(grid), field, placer, {}, {.tolerance_m = 2});
}

TEST(BackedField, MeshIsWithinTheToleranceOfEverySample) {
  const StrictResult result = collapse(hills(), Behind::kHeights);
  EXPECT_LE(error_m(result.mesh, hills()), 2);
  EXPECT_LT(result.mesh.triangles.size(), 2U * 64 * 64 / 8);
}

TEST(BackedField, MeshIsWithinTheToleranceWhereOnlySlabsAreBehind) {
  const StrictResult result = collapse(hills(), Behind::kSlabs);
  EXPECT_LE(error_m(result.mesh, hills()), 2);
  EXPECT_LT(result.mesh.triangles.size(), 2U * 64 * 64 / 4);
}

TEST(BackedField, SlabsBesideTheHeightsChangeNothing) {
  const TerrainMesh with = collapse(hills(), Behind::kBoth).mesh;
  const TerrainMesh without = collapse(hills(), Behind::kHeights).mesh;
  EXPECT_EQ(with.triangles, without.triangles);
  EXPECT_TRUE(std::ranges::equal(
      with.vertices, without.vertices, {}, [](const TerrainVertex& v) { return v.place.height_m; },
      [](const TerrainVertex& v) { return v.place.height_m; }));
}

TEST(BackedField, WithoutTheOthersBehindItTheMeshIsNot) {
  EXPECT_GT(error_m(collapse(hills(), Behind::kNothing).mesh, hills()), 2);
}

TEST(BackedField, ATriangleOnItsWayIsHeldAgainstTheOthersToo) {
  const HeightGrid grid =
      grid_of(65, 65, [](auto c, auto r) { return c == 22 && r == 37 ? 9 : 0; });
  const std::array<FieldPoint, 3> from{{{20, 36, 0}, {20, 38, 0}, {21, 37, 0}}};
  std::array<FieldPoint, 3> to = from;
  to[2] = {24, 37, 0};  // over the spike
  const MovingTriangle moving(from, to, 1e-7);
  EXPECT_TRUE(moving.stays_within(reduced(grid, Behind::kHeights), 9.5));
  EXPECT_FALSE(moving.stays_within(reduced(grid, Behind::kHeights), 8));
  EXPECT_TRUE(moving.stays_within(reduced(grid, Behind::kNothing), 8));
}

}  // namespace
}  // namespace terrane::hierarchy

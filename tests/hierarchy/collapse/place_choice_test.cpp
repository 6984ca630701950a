#include "hierarchy/collapse/place_choice.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/hierarchy/test_meshes.h"

namespace terrane::hierarchy {
namespace {

using testing::ExactPlacer;
using testing::field_of;
using testing::grid_of;
using testing::terrain_of;

constexpr int kSide = 9;

std::uint32_t vertex_at(int column, int row) {
  return static_cast<std::uint32_t>(row * kSide + column);
}

/// A grid of samples, each a vertex, and the edge in its middle.
class MiddleEdge {
 public:
  template <class Height>
  explicit MiddleEdge(Height height)
      : grid_(grid_of(kSide, kSide, height)),
        field_(field_of(grid_)),
        terrain_(terrain_of(grid_)),
        mesh_(static_cast<std::uint32_t>(terrain_.vertices.size()), terrain_.triangles),
        samples_(field_, terrain_.vertices, terrain_.triangles, mesh_.triangle_count()) {}

  TerrainVertex& vertex(int column, int row) { return terrain_.vertices[vertex_at(column, row)]; }

  std::optional<Place> place_for_edge(const PlaceSearch& search, const ShapeLimits& shape = {},
                                      MorphGuard* guard = nullptr) {
    StencilWalker walker(mesh_);
    Stencil stencil;
    EXPECT_EQ(walker.around_edge(edge(vertex_at(4, 4), vertex_at(5, 4)), stencil),
              Collapsibility::kYes);
    PlaceChoice choice(surroundings(shape, guard));
    choice.set_search(search);
    const auto place = choice.for_core(stencil);
    refusal_ = choice.refusal();
    return place;
  }

  std::optional<Place> place_for_vertex(int column, int row, const PlaceSearch& search) {
    const VertexId v{vertex_at(column, row)};
    Stencil stencil;
    StencilWalker(mesh_).around_vertex(v, stencil);
    const ShapeLimits shape;
    PlaceChoice choice(surroundings(shape, nullptr));
    choice.set_search(search);
    return choice.for_vertex(stencil, v, 2);
  }

  MorphGuard guard(double tolerance_m) const {
    std::vector<Place> finer;
    for (const TerrainVertex& vertex : terrain_.vertices) finer.push_back(vertex.place);
    return MorphGuard(finer, terrain_.triangles, terrain_.vertices, field_, placer_, tolerance_m);
  }

  Collapsibility refusal() const { return refusal_; }

 private:
  PlaceSurroundings surroundings(const ShapeLimits& shape, MorphGuard* guard) const {
    return {mesh_, terrain_.vertices, samples_, field_, placer_, shape, guard};
  }

  HalfedgeId edge(std::uint32_t from, std::uint32_t to) const {
    for (std::uint32_t t = 0; t < terrain_.triangles.size(); ++t) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        const HalfedgeId h = HalfedgeMesh::halfedge(TriangleId{t}, k);
        if (index(mesh_.start(h)) == from && index(mesh_.end(h)) == to) return h;
      }
    }
    return kNoHalfedge;
  }

  HeightGrid grid_;
  SampleField field_;
  TerrainMesh terrain_;
  HalfedgeMesh mesh_;
  CoveredSamples samples_;
  ExactPlacer placer_;
  Collapsibility refusal_ = Collapsibility::kYes;
};

double ridge_at_5(std::int64_t column, std::int64_t /*row*/) {
  return -10 * std::abs(static_cast<double>(column - 5));
}

TEST(PlaceChoice, CoreGoesToTheCornerOnTheRidge) {
  MiddleEdge ridge(ridge_at_5);
  const auto place = ridge.place_for_edge({.tolerance_m = 1});
  ASSERT_TRUE(place);
  EXPECT_EQ(place->plan, ridge.vertex(5, 4).place.plan);
  EXPECT_NEAR(place->height_m, 0, 1e-3);
}

TEST(PlaceChoice, NoPlaceIsNearBothAPeakAndAPit) {
  MiddleEdge both([](auto c, auto r) { return r != 4 ? 0 : c == 4 ? 10 : c == 5 ? -10 : 0; });
  EXPECT_FALSE(both.place_for_edge({.tolerance_m = 1}));
  EXPECT_EQ(both.refusal(), Collapsibility::kOverTolerance);
}

TEST(PlaceChoice, VertexInWaterKeepsTheWatersHeight) {
  MiddleEdge lake([](auto, auto) { return 2; });
  for (const int column : {4, 5}) lake.vertex(column, 4).water_m = 1.5F;
  const auto place = lake.place_for_edge({.tolerance_m = 1});
  ASSERT_TRUE(place);
  EXPECT_EQ(place->height_m, 1.5);
}

TEST(PlaceChoice, TooThinAStarIsRefused) {
  MiddleEdge flat([](auto, auto) { return 0; });
  EXPECT_TRUE(flat.place_for_edge({.tolerance_m = 1}, {.smallest_altitude_cells = 0.5}));
  // no triangle of a star of two cells across is thicker than a cell
  EXPECT_FALSE(flat.place_for_edge({.tolerance_m = 1}, {.smallest_altitude_cells = 1.1}));
  EXPECT_EQ(flat.refusal(), Collapsibility::kNotStarShaped);
}

TEST(PlaceChoice, PlaceThatTheBlendRefusesIsNotChosen) {
  MiddleEdge bump([](auto c, auto r) { return c == 4 && r == 4 ? 3 : 0; });
  MorphGuard loose = bump.guard(4), strict = bump.guard(1);
  EXPECT_TRUE(bump.place_for_edge({.tolerance_m = 4}, {}, &loose));
  EXPECT_FALSE(bump.place_for_edge({.tolerance_m = 4}, {}, &strict));
  EXPECT_EQ(bump.refusal(), Collapsibility::kMorph);
}

TEST(PlaceChoice, RaisedVertexGoesBackToTheSamples) {
  MiddleEdge plane([](auto c, auto) { return 3 * c; });
  EXPECT_FALSE(plane.place_for_vertex(4, 4, {.tolerance_m = 1})) << "it is best where it is";
  plane.vertex(4, 4).place.height_m += 0.5;
  plane.vertex(4, 4).place.lattice.k += 512;
  const auto place = plane.place_for_vertex(4, 4, {.tolerance_m = 1});
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->height_m, 3 * column_of(place->plan), 1e-3);
}

}  // namespace
}  // namespace terrane::hierarchy

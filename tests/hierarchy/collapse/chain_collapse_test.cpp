#include "hierarchy/collapse/chain_collapse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <set>

#include "tests/hierarchy/test_meshes.h"

namespace terrane::hierarchy {
namespace {

using testing::ExactPlacer;
using testing::field_of;
using testing::grid_of;

constexpr std::int64_t kRow = 2;

Place place_at(const SampleId& at, double height_m) {
  return ExactPlacer().place({at.column * kUnitsPerCell, -at.row * kUnitsPerCell}, height_m);
}

/// A full-resolution mesh of five rows; the chain is the middle one, all of which may go.
struct Seam {
  HeightGrid grid;
  TerrainMesh mesh;
  std::vector<std::uint32_t> chain;

  template <class Height>
  Seam(std::int64_t columns, Height height)
      : grid(grid_of(columns, 5, height)), mesh(testing::terrain_of(grid)) {
    const GridTriangles full = triangulate(grid, grid.window);
    for (std::uint32_t v = 0; v < full.vertices.size(); ++v) {
      if (full.vertices[v].row != kRow) continue;
      chain.push_back(v);
      mesh.vertices[v].kind = VertexKind::kOutline;
      mesh.vertices[v].border = full.vertices[v];
    }
  }

  ChainResult collapse(double tolerance_m, const FinerLevel& finer = {},
                       double blend_tolerance_m = 1) const {
    return collapse_chain(mesh, chain, finer, field_of(grid), ExactPlacer(),
                          {.tolerance_m = tolerance_m, .blend_tolerance_m = blend_tolerance_m});
  }

  /// The same, and vertices may go up and down and along the chain.
  ChainResult collapse_and_move(double tolerance_m, const FinerLevel& finer = {},
                                double blend_tolerance_m = 1) const {
    ChainOptions options{.tolerance_m = tolerance_m, .blend_tolerance_m = blend_tolerance_m};
    options.place_at = place_at;
    return collapse_chain(mesh, chain, finer, field_of(grid), ExactPlacer(), options);
  }

  /// Where the vertices that stay are now.
  std::set<std::int64_t> kept_columns(const ChainResult& result) const {
    std::set<std::int64_t> columns;
    for (const std::uint32_t v : chain) columns.insert(column_of(result, result.target[v]));
    return columns;
  }

  static std::int64_t column_of(const ChainResult& result, std::uint32_t v) {
    return static_cast<std::int64_t>(result.borders[v].column);
  }

  /// The triangles after the collapses: corners moved, those with two alike left out.
  std::vector<Corners> triangles_after(const ChainResult& result) const {
    std::vector<Corners> triangles;
    for (const auto& [a, b, c] : mesh.triangles) {
      const Corners t{result.target[a], result.target[b], result.target[c]};
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
    }
    return triangles;
  }
};

TEST(ChainCollapse, ASeamOverAPlaneKeepsItsEndsOnly) {
  const Seam seam(33, [](auto c, auto r) { return 3.0 * c - 2.0 * r; });
  EXPECT_EQ(seam.kept_columns(seam.collapse(0.01)), (std::set<std::int64_t>{0, 32}));
}

TEST(ChainCollapse, KeepsTheCornersOfABrokenLineAndNothingElse) {
  const Seam seam(33, [](auto c, auto) {
    return c < 8 ? 5.0 * c : c < 20 ? 48.0 - c : 3.0 * c - 32;
  });
  EXPECT_EQ(seam.kept_columns(seam.collapse(0.01)), (std::set<std::int64_t>{0, 8, 20, 32}));
}

TEST(ChainCollapse, LockedVerticesStay) {
  Seam seam(17, [](auto, auto) { return 4.0; });
  seam.mesh.vertices[seam.chain[5]].kind = VertexKind::kLocked;
  EXPECT_EQ(seam.kept_columns(seam.collapse(1)), (std::set<std::int64_t>{0, 5, 16}));
}

TEST(ChainCollapse, AVertexOnTheRimOfAHoleStays) {
  // without (8, 1), the triangles around (8, 2) leave a gap on one side; its neighbours have none
  const Seam seam(17, [](auto c, auto r) { return c == 8 && r == 1 ? NAN : 4.0; });
  EXPECT_EQ(seam.kept_columns(seam.collapse(1)), (std::set<std::int64_t>{0, 8, 16}));
}

TEST(ChainCollapse, OneSideThatCannotGoWithoutAVertexKeepsItForBoth) {
  // level 1 beside a seam: far vertices two rows off, and a sample between that only the kept edge
  // of the upper side follows
  HeightGrid grid = grid_of(3, 5, [](auto c, auto r) { return c == 1 && r == 1 ? 6.0 : 0.0; });
  TerrainMesh mesh;
  for (const SampleId s :
       {SampleId{0, 2}, {1, 2}, {2, 2}, {0, 0}, {1, 0}, {2, 0}, {0, 4}, {2, 4}}) {
    mesh.vertices.push_back(
        {.place = ExactPlacer().place({s.column * kUnitsPerCell, -s.row * kUnitsPerCell},
                                      s == SampleId{1, 0} ? 8.0 : 0.0),
         .kind = VertexKind::kOutline});
  }
  mesh.triangles = {{0, 1, 3}, {1, 4, 3}, {1, 5, 4}, {1, 2, 5}, {0, 6, 1}, {6, 7, 1}, {1, 7, 2}};
  const std::vector<std::uint32_t> chain{0, 1, 2};
  // with vertex 1, the mesh is 4 m high at (1, 1) and 2 m off; without it, at most 8 / 2 / 2 + 2
  const auto collapses = [&](double tolerance_m) {
    return collapse_chain(mesh, chain, {}, field_of(grid), ExactPlacer(),
                          {.tolerance_m = tolerance_m, .blend_tolerance_m = 1})
        .collapses;
  };
  EXPECT_EQ(collapses(1), 0);
  EXPECT_EQ(collapses(20), 1);
}

TEST(ChainCollapse, ABlendThatLeavesItsToleranceIsRefused) {
  const Seam bump(9, [](auto c, auto r) { return c == 4 && r == kRow ? 1.0 : 0.0; });
  FinerLevel finer{.places = {}, .triangles = bump.mesh.triangles, .target = {}};
  for (const TerrainVertex& vertex : bump.mesh.vertices) finer.places.push_back(vertex.place);
  EXPECT_EQ(bump.kept_columns(bump.collapse(2, finer, 2)), (std::set<std::int64_t>{0, 8}));
  const ChainResult strict = bump.collapse(2, finer, 0.5);
  EXPECT_TRUE(bump.kept_columns(strict).contains(4));
  EXPECT_GT(strict.refused_by_blend, 0);
}

TEST(ChainCollapse, AnArcNeedsFewerVerticesWhereTheyMayRise) {
  // a chord of n cells is at most n^2 / 400 m above the arc; half of that if its ends may sink
  const Seam arc(81, [](auto c, auto) { return static_cast<double>(c * c) / 100; });
  const auto kept = arc.kept_columns(arc.collapse(0.5));
  const ChainResult raised = arc.collapse_and_move(0.5);
  EXPECT_LT(arc.kept_columns(raised).size(), kept.size());
  for (const std::uint32_t end : {arc.chain.front(), arc.chain.back()}) {
    EXPECT_EQ(raised.places[end].height_m, arc.mesh.vertices[end].place.height_m);
    EXPECT_TRUE(std::isnan(raised.raised_m[end]));
  }
}

TEST(ChainCollapse, TwoVerticesBecomeOneAtTheSampleWhereTheGroundBends) {
  // a ridge across the seam at column 4, where neither side's mesh has a vertex on the seam
  HeightGrid grid = grid_of(9, 5, [](auto c, auto) { return 12.0 - 3.0 * std::abs(c - 4.0); });
  TerrainMesh mesh;
  for (const SampleId s :
       {SampleId{0, 2}, {3, 2}, {5, 2}, {8, 2}, {0, 0}, {4, 0}, {8, 0}, {0, 4}, {4, 4}, {8, 4}}) {
    mesh.vertices.push_back(
        {.place = ExactPlacer().place({s.column * kUnitsPerCell, -s.row * kUnitsPerCell},
                                      grid.at(s.column, s.row)),
         .kind = VertexKind::kOutline,
         .border = s});
  }
  mesh.triangles = {{0, 1, 4}, {1, 5, 4}, {1, 2, 5}, {2, 3, 6}, {2, 6, 5},
                    {0, 7, 1}, {7, 8, 1}, {1, 8, 2}, {2, 8, 9}, {2, 9, 3}};
  const std::vector<std::uint32_t> chain{0, 1, 2, 3};
  ChainOptions options{.tolerance_m = 0.01, .blend_tolerance_m = 1};
  EXPECT_EQ(collapse_chain(mesh, chain, {}, field_of(grid), ExactPlacer(), options).collapses, 0);
  options.place_at = place_at;
  const ChainResult result =
      collapse_chain(mesh, chain, {}, field_of(grid), ExactPlacer(), options);
  ASSERT_EQ(result.collapses, 1);
  EXPECT_EQ(result.target[1], result.target[2]);
  const std::uint32_t v = result.target[1];
  EXPECT_EQ(result.borders[v], BorderPlace(4, kRow));
  EXPECT_EQ(result.places[v].plan, (GridPoint{4 * kUnitsPerCell, -kRow * kUnitsPerCell}));
  EXPECT_EQ(result.places[v].height_m, 12);
}

TEST(ChainCollapse, ALockedVertexKeepsItsHeight) {
  Seam seam(17, [](auto c, auto) { return c % 2 == 0 ? 0.5 : -0.5; });
  seam.mesh.vertices[seam.chain[6]].kind = VertexKind::kLocked;
  const ChainResult result = seam.collapse_and_move(2);
  EXPECT_EQ(result.places[seam.chain[6]].height_m, 0.5);
}

TEST(ChainCollapse, ARiseThatTheBlendDoesNotAllowIsRefused) {
  const Seam bump(9, [](auto c, auto r) { return c == 4 && r == kRow ? 1.0 : 0.0; });
  FinerLevel finer{.places = {}, .triangles = bump.mesh.triangles, .target = {}};
  for (const TerrainVertex& vertex : bump.mesh.vertices) finer.places.push_back(vertex.place);
  const ChainResult strict = bump.collapse_and_move(2, finer, 0.1);
  for (const std::uint32_t v : bump.chain) {
    if (strict.target[v] != v) continue;
    EXPECT_NEAR(strict.places[v].height_m, Seam::column_of(strict, v) == 4 ? 1 : 0,
                0.1 + 1.0 / 1024);
  }
}

class RandomSeam : public ::testing::TestWithParam<unsigned> {};

TEST_P(RandomSeam, StaysWithinTheBoundAndFoldsNothing) {
  std::mt19937 random(GetParam());
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
  };
  const double relief_m = uniform(0, 30), roughness_m = uniform(0, 5);
  const Seam seam(static_cast<std::int64_t>(uniform(3, 70)), [&](auto c, auto r) {
    return relief_m * std::sin(0.2 * static_cast<double>(c + r)) + uniform(0, roughness_m);
  });
  const double tolerance_m = uniform(0.3, 8);

  const ChainResult result =
      GetParam() % 2 == 0 ? seam.collapse(tolerance_m) : seam.collapse_and_move(tolerance_m);

  double area = 0;
  for (const auto& [a, b, c] : seam.triangles_after(result)) {
    const auto plan = [&](std::uint32_t v) { return result.places[v].plan; };
    const auto twice = static_cast<double>(orient2d(plan(a), plan(b), plan(c)));
    EXPECT_GT(twice, 0);
    area += twice / 2 / kUnitsPerCell / kUnitsPerCell;
  }
  // all turn the same way and cover as much as before: nothing overlaps
  EXPECT_NEAR(area, 4.0 * static_cast<double>(seam.grid.window.columns - 1), 1e-9);

  // along the seam the mesh is a broken line through the kept vertices
  std::map<std::int64_t, double> kept_m;
  for (const std::uint32_t v : seam.chain) {
    const std::uint32_t onto = result.target[v];
    kept_m[Seam::column_of(result, onto)] = result.places[onto].height_m;
  }
  for (auto from = kept_m.begin(), to = std::next(from); to != kept_m.end(); ++from, ++to) {
    const auto [first, at_from] = *from;
    const auto [last, at_to] = *to;
    for (std::int64_t c = first; c < last; ++c) {
      const double t = static_cast<double>(c - first) / static_cast<double>(last - first);
      // heights are placed in 1/1024 m
      EXPECT_LE(std::abs(at_from + t * (at_to - at_from) - seam.grid.at(c, kRow)),
                tolerance_m + 2.0 / 1024);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomSeam, ::testing::Range(0U, 100U));

}  // namespace
}  // namespace terrane::hierarchy

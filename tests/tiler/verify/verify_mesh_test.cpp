#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/tiler/verify/fake_output.h"

namespace terrane::verify::testing {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr GridShape kShape{17, 17};  // 4 x 4 leaf tiles of 4 cells, three levels

// places of t = 1/4, 1/2 and 3/4 in kMorphTimes
constexpr std::size_t kQuarter = 3, kHalf = 6, kThreeQuarters = 9;
static_assert(kMorphTimes[kQuarter] == 0.25 && kMorphTimes[kHalf] == 0.5 &&
              kMorphTimes[kThreeQuarters] == 0.75);

/// A slope: every triangle of any size lies in it exactly.
FakeDem slope() {
  return {kShape, [](auto column, auto row) { return static_cast<float>(4 * column + 8 * row); }};
}

/// A flat plain whose odd columns stand 1 m higher.
FakeDem ridges() {
  return {kShape, [](auto column, auto) { return column % 2 == 1 ? 1.0F : 0.0F; }};
}

struct SlopeOutput : ::testing::Test {
  FakeDem dem = slope();
  FlatPlace place;
  FakeOutput output = halved_grids(dem, flat_world(place), 4, 1);

  VerifyReport verdict() const { return verdict_on(output, dem, place); }
};

TEST_F(SlopeOutput, HoldsWhenEveryTriangleLiesInTheSlope) {
  const VerifyReport report = verdict();
  EXPECT_TRUE(report.holds()) << to_text(report);
  EXPECT_THAT(report.problems, ::testing::IsEmpty());
  ASSERT_EQ(report.levels.size(), 3U);
  for (const LevelReport& level : report.levels) {
    EXPECT_EQ(level.samples, 17 * 17);
    EXPECT_EQ(level.max_error_m, 0);
    for (const MorphReport& morph : level.morph) EXPECT_NEAR(morph.max_error_m, 0, 1e-9);
  }
}

TEST_F(SlopeOutput, CountsTilesTrianglesAndSeamVertices) {
  const VerifyReport report = verdict();
  const std::array<std::int64_t, 3> tiles = {16, 4, 1};
  const std::array<std::int64_t, 3> triangles = {2 * 16 * 16, 2 * 8 * 8, 2 * 4 * 4};
  // 24 seams of 5 vertices between leaves, 4 between the tiles of level 1
  const std::array<std::int64_t, 3> seam_vertices = {24 * 5, 4 * 5, 0};
  for (std::size_t level = 0; level < 3; ++level) {
    EXPECT_EQ(report.levels[level].tiles, tiles[level]);
    EXPECT_EQ(report.levels[level].triangles, triangles[level]);
    EXPECT_EQ(report.levels[level].seam_vertices, seam_vertices[level]);
  }
}

TEST(VerifySamples, FindTheKnownErrorsOfALevelThatMissesEveryOtherColumn) {
  const FakeDem dem = ridges();
  const FlatPlace place;
  const VerifyReport report = verdict_on(halved_grids(dem, flat_world(place), 4, 1), dem, place);
  EXPECT_TRUE(report.holds()) << to_text(report);
  EXPECT_EQ(report.levels[0].max_error_m, 0);
  EXPECT_DOUBLE_EQ(report.levels[1].max_error_m, 1);
  EXPECT_NEAR(report.levels[1].rms_error_m, std::sqrt(8.0 / 17), 1e-12);
  // half-way the ridge stands at column 1 - t, 1 - t high, and falls to column 2
  for (const MorphReport& morph : report.levels[0].morph) {
    EXPECT_NEAR(morph.max_error_m, 2 * morph.t / (1 + morph.t), 1e-12);
  }
}

TEST(VerifySamples, AreCoveredByASiblingWhenTheSeamBetweenThemMoves) {
  // leaves of 3 cells: their seam at column 3 goes to column 2, which is no border of level 1
  const FakeDem dem({13, 13},
                    [](auto column, auto row) { return static_cast<float>(4 * column + 8 * row); });
  const FlatPlace place;
  const VerifyReport report = verdict_on(halved_grids(dem, flat_world(place), 3, 1), dem, place);
  EXPECT_TRUE(report.holds()) << to_text(report);
  EXPECT_EQ(report.levels.size(), 3U);
}

TEST(VerifySamples, AreOverTheToleranceByTheSmallestAmount) {
  const FakeDem dem = ridges();
  const FlatPlace place;
  FakeOutput output = halved_grids(dem, flat_world(place), 4, 1);
  output.levels[2].tolerance_m = 0.999999;
  const VerifyReport report = verdict_on(output, dem, place);
  EXPECT_FALSE(report.holds());
  EXPECT_EQ(report.levels[2].samples_over_tolerance, 8 * 17);
  EXPECT_EQ(report.levels[1].samples_over_tolerance, 0);
  // level 1 ends as level 2: its morph is held to that tolerance
  EXPECT_EQ(report.levels[1].morph[kQuarter].samples_over_tolerance, 8 * 17);
}

TEST_F(SlopeOutput, ALiftedVertexIsNamedWithItsSample) {
  FakeTile& tile = output.tile(0, 1, 2);
  tile.position[tile.vertex_at(6, 10)][2] += 6;  // 1.5 m
  const VerifyReport report = verdict();
  EXPECT_FALSE(report.holds());
  EXPECT_EQ(report.levels[0].samples_over_tolerance, 1);
  EXPECT_DOUBLE_EQ(report.levels[0].max_error_m, 1.5);
  EXPECT_THAT(report.problems, Contains(::testing::AllOf(HasSubstr("tile 0/1/2: 1 samples over"),
                                                         HasSubstr("column 6, row 10"))));
}

TEST_F(SlopeOutput, ALiftedVertexIsFoundInTheMorphToo) {
  FakeTile& tile = output.tile(1, 0, 0);
  const std::size_t vertex = tile.vertex_at(4, 4);
  tile.morph[vertex][2] += 16;  // 8 m higher at t = 1, on the lattice of 1 m
  const VerifyReport report = verdict();
  EXPECT_EQ(report.levels[1].max_error_m, 0);
  EXPECT_DOUBLE_EQ(report.levels[1].morph[kQuarter].max_error_m, 2);
  EXPECT_DOUBLE_EQ(report.levels[1].morph[kHalf].max_error_m, 4);
  EXPECT_DOUBLE_EQ(report.levels[1].morph[kThreeQuarters].max_error_m, 6);
  EXPECT_EQ(report.levels[1].morph[kHalf].samples_over_tolerance, 0);  // 4 m is allowed
  EXPECT_GT(report.levels[1].morph[kThreeQuarters].samples_over_tolerance, 0);
}

TEST_F(SlopeOutput, ASampleOnASeamIsCountedOnceWhenBothTilesMissIt) {
  for (FakeTile* tile : {&output.tile(0, 0, 0), &output.tile(0, 1, 0)}) {
    tile->position[tile->vertex_at(4, 2)][2] += 8;
  }
  EXPECT_EQ(verdict().levels[0].samples_over_tolerance, 1);
}

TEST_F(SlopeOutput, ASeamVertexLiftedByOneStepInOneTileIsACrack) {
  FakeTile& tile = output.tile(0, 0, 0);
  const std::size_t vertex = tile.vertex_at(4, 1);
  tile.position[vertex][2] += 1;
  tile.morph[vertex][2] -= 1;  // it still ends where it should
  const VerifyReport report = verdict();
  EXPECT_FALSE(report.holds());
  EXPECT_EQ(report.levels[0].mismatched_same_level, 2);  // one vertex, in two versions
  EXPECT_EQ(report.levels[0].mismatched_across_levels, 0);
  EXPECT_EQ(report.levels[0].parent_triangles_missing, 0);
  EXPECT_THAT(report.problems,
              Contains(::testing::AllOf(HasSubstr("tile 0/0/0"), HasSubstr("column 4, row 1.00"))));
}

TEST_F(SlopeOutput, ASeamVertexThatMovesElsewhereInOneTileIsACrack) {
  FakeTile& tile = output.tile(0, 0, 0);
  tile.morph[tile.vertex_at(2, 4)][1] += 4;
  EXPECT_EQ(verdict().levels[0].mismatched_same_level, 2);
}

TEST_F(SlopeOutput, ASeamVertexOffTheNextLevelInBothTilesIsACrackAcrossLevels) {
  for (FakeTile* tile : {&output.tile(0, 1, 0), &output.tile(0, 2, 0)}) {
    tile->morph[tile->vertex_at(8, 2)][2] += 1;  // half a step of level 1
  }
  const VerifyReport report = verdict();
  EXPECT_FALSE(report.holds());
  EXPECT_EQ(report.levels[0].mismatched_same_level, 0);
  // row 3 still goes to (8, 2): each parent sees the new place only as an extra one
  EXPECT_EQ(report.levels[0].mismatched_across_levels, 2);
}

TEST_F(SlopeOutput, AMissingSeamVertexIsACrack) {
  FakeTile& tile = output.tile(0, 2, 1);
  // the two border edges (12, 5)-(12, 6)-(12, 7) become one: a T-junction
  const std::size_t dropped = tile.vertex_at(12, 6);
  const auto kept = static_cast<std::uint32_t>(tile.vertex_at(12, 5));
  for (auto& triangle : tile.triangles) {
    for (auto& vertex : triangle) {
      if (vertex == dropped) vertex = kept;
    }
  }
  std::erase_if(tile.triangles,
                [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  EXPECT_EQ(verdict().levels[0].mismatched_same_level, 1);
}

TEST_F(SlopeOutput, ADroppedRootTriangleUncoversTheSamplesInsideIt) {
  FakeTile& root = output.tile(2, 0, 0);
  const std::size_t triangle = root.triangle_at({{{4, 4}, {4, 8}, {8, 8}}});
  root.triangles.erase(root.triangles.begin() + static_cast<std::ptrdiff_t>(triangle));
  const VerifyReport report = verdict();
  EXPECT_FALSE(report.holds());
  EXPECT_EQ(report.levels[2].uncovered_samples, 3);  // strictly inside 4 x 4 / 2 cells
  EXPECT_EQ(report.levels[1].parent_triangles_extra, 1);
  EXPECT_EQ(report.levels[1].parent_triangles_missing, 0);
  EXPECT_THAT(report.problems, Contains(HasSubstr("3 samples uncovered, the first at (column 5")));
}

TEST_F(SlopeOutput, ADroppedLeafTriangleIsMissingFromTheParent) {
  FakeTile& tile = output.tile(0, 1, 1);
  const std::size_t triangle = tile.triangle_at({{{5, 5}, {5, 6}, {6, 6}}});
  tile.triangles.erase(tile.triangles.begin() + static_cast<std::ptrdiff_t>(triangle));
  const VerifyReport report = verdict();
  EXPECT_EQ(report.levels[0].parent_triangles_missing, 1);
  EXPECT_EQ(report.levels[0].parent_triangles_extra, 0);
}

TEST_F(SlopeOutput, ATriangleTurnedOverIsFolded) {
  FakeTile& tile = output.tile(1, 1, 0);
  std::swap(tile.triangles[3][0], tile.triangles[3][1]);
  const VerifyReport report = verdict();
  EXPECT_EQ(report.levels[1].folded_triangles, 1);
  EXPECT_EQ(report.levels[1].morph[kHalf].folded_triangles, 1);
  EXPECT_THAT(report.problems, Contains(HasSubstr("tile 1/1/0: 1 triangles folded at t = 0,")));
}

TEST_F(SlopeOutput, ATriangleWithoutAreaIsFolded) {
  FakeTile& tile = output.tile(0, 0, 0);
  tile.triangles[0][1] = tile.triangles[0][2];
  EXPECT_EQ(verdict().levels[0].folded_triangles, 1);
}

TEST_F(SlopeOutput, AVertexThatOvertakesItsNeighbourOnItsWayIsAFold) {
  FakeTile& tile = output.tile(1, 0, 0);
  // from column 6 to column 0 past columns 4 and 2: upright at t = 0, over the others half-way
  tile.morph[tile.vertex_at(6, 2)][0] -= 64;
  const VerifyReport report = verdict();
  EXPECT_EQ(report.levels[1].folded_triangles, 0);
  EXPECT_GT(report.levels[1].morph[kHalf].folded_triangles, 0);
}

TEST_F(SlopeOutput, ASpoiledMorphDoesNotBecomeTheParent) {
  FakeTile& tile = output.tile(0, 1, 1);
  tile.morph[tile.vertex_at(6, 6)][2] += 2;  // one step of level 1
  const VerifyReport report = verdict();
  EXPECT_FALSE(report.holds());
  // both triangles of the cell (5, 5) end elsewhere; those to the south and east should have shrunk
  // to lines and do not
  EXPECT_EQ(report.levels[0].parent_triangles_missing, 2);
  EXPECT_GT(report.levels[0].parent_triangles_extra, 2);
  EXPECT_THAT(report.problems, Contains(HasSubstr("tile 1/0/0: its children at t = 1")));
}

TEST_F(SlopeOutput, AVertexInTwoVersionsThatPartTearsTheTile) {
  FakeTile& tile = output.tile(0, 0, 0);
  const std::size_t vertex = tile.vertex_at(2, 2);
  tile.position.push_back(tile.position[vertex]);
  tile.morph.push_back({4, 0, 2});
  tile.sample.push_back({-1, -1});
  const std::size_t triangle = tile.triangle_at({{{2, 2}, {2, 3}, {3, 3}}});
  for (auto& corner : tile.triangles[triangle]) {
    if (corner == vertex) corner = static_cast<std::uint32_t>(tile.position.size() - 1);
  }
  const VerifyReport report = verdict();
  EXPECT_EQ(report.levels[0].torn_edges, 4);  // two edges, seen from either side
}

TEST_F(SlopeOutput, AVertexInTwoVersionsThatStayTogetherIsFine) {
  FakeTile& tile = output.tile(0, 0, 0);
  const std::size_t vertex = tile.vertex_at(2, 2);
  tile.position.push_back(tile.position[vertex]);
  tile.morph.push_back(tile.morph[vertex]);
  tile.sample.push_back({-1, -1});
  const std::size_t triangle = tile.triangle_at({{{2, 2}, {2, 3}, {3, 3}}});
  for (auto& corner : tile.triangles[triangle]) {
    if (corner == vertex) corner = static_cast<std::uint32_t>(tile.position.size() - 1);
  }
  EXPECT_TRUE(verdict().holds());
}

TEST_F(SlopeOutput, ARootThatMorphsIsFound) {
  output.tile(2, 0, 0).morph[5] = {0, 0, 1};
  EXPECT_EQ(verdict().levels[2].root_morphs, 1);
}

TEST_F(SlopeOutput, TheReportDoesNotDependOnTheNumberOfThreads) {
  FakeTile& tile = output.tile(0, 1, 2);
  tile.position[tile.vertex_at(4, 10)][2] += 9;
  std::swap(output.tile(0, 3, 3).triangles[0][0], output.tile(0, 3, 3).triangles[0][1]);
  const WrittenOutput written(output);
  NoProgress progress;
  const auto serial = verify(written.folder(), dem, place, {.jobs = 1}, progress);
  const auto parallel = verify(written.folder(), dem, place, {.jobs = 4}, progress);
  EXPECT_FALSE(serial.holds());
  EXPECT_EQ(to_json(serial), to_json(parallel));
}

// --- voids

/// A void over the samples (3..5, 2..3): across the seam at column 4.
FakeDem slope_with_void() {
  return {{9, 5}, [](auto column, auto row) {
            const bool is_void = column >= 3 && column <= 5 && row >= 2 && row <= 3;
            return is_void ? kNoHeight : static_cast<float>(column + 2 * row);
          }};
}

TEST(VerifyVoids, AreNoTerrainAndInterruptTheSeam) {
  const FakeDem dem = slope_with_void();
  const FlatPlace place;
  const VerifyReport report = verdict_on(repeated_grids(dem, flat_world(place), 4, 1), dem, place);
  EXPECT_TRUE(report.holds()) << to_text(report);
  // (4, 4) has a height, but the cells above it have no other two
  EXPECT_EQ(report.levels[0].samples, 9 * 5 - 6 - 1);
  // the seam goes from row 0 to row 1
  EXPECT_EQ(report.levels[0].seam_vertices, 2);
}

TEST(VerifyVoids, ATileWithoutTerrainIsNeitherMissedNorAllowed) {
  const FakeDem dem({9, 5}, [](auto column, auto) { return column > 4 ? kNoHeight : 1.0F; });
  const FlatPlace place;
  FakeOutput output = repeated_grids(dem, flat_world(place), 4, 1);
  EXPECT_EQ(output.tiles.size(), 2U);  // 0/0/0 and the root
  EXPECT_TRUE(verdict_on(output, dem, place).holds());
  FakeTile invented = output.tile(0, 0, 0);
  invented.x = 1;
  output.tiles.push_back(invented);
  const VerifyReport report = verdict_on(output, dem, place);
  EXPECT_EQ(report.levels[0].tiles_unexpected, 1);
  EXPECT_THAT(report.problems, Contains(HasSubstr("tile 0/1/0: the DEM has no terrain there")));
}

// --- outlines that do not lie on the lattice

TEST(VerifyRotatedGrids, CoverSamplesWithinOneStepOfTheOutline) {
  const FakeDem dem(kShape, [](auto, auto) { return 100.0F; });
  const FlatPlace place(/*rotation_rad=*/0.5);
  const VerifyReport report = verdict_on(repeated_grids(dem, flat_world(place), 4, 1), dem, place);
  EXPECT_TRUE(report.holds()) << to_text(report);
  EXPECT_EQ(report.levels[0].seam_vertices, 24 * 5);
}

TEST(VerifyRotatedGrids, UncoverSamplesFartherThanOneStepFromTheOutline) {
  const FakeDem dem(kShape, [](auto, auto) { return 100.0F; });
  const FlatPlace place(/*rotation_rad=*/0.5);
  FakeOutput output = repeated_grids(dem, flat_world(place), 4, 1);
  FakeTile& tile = output.tile(0, 0, 0);
  // 1 m to the east, four steps; the outline runs 0.5 rad off the north
  tile.position[tile.vertex_at(0, 2)][0] += 4;
  EXPECT_EQ(verdict_on(output, dem, place).levels[0].uncovered_samples, 1);
}

}  // namespace
}  // namespace terrane::verify::testing

#include "hierarchy/collapse/morph_guard.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/hierarchy/test_meshes.h"

namespace terrane::hierarchy {
namespace {

using testing::ExactPlacer;
using testing::field_of;
using testing::grid_of;
using testing::terrain_of;

Place cell(double column, double row, double height_m) {
  return ExactPlacer().place({static_cast<std::int32_t>(column * kUnitsPerCell),
                              static_cast<std::int32_t>(-row * kUnitsPerCell)},
                             height_m);
}

/// 5 x 5 flat samples; vertex 12 is the middle one.
class FlatGuard : public ::testing::Test {
 protected:
  FlatGuard() : grid_(grid_of(5, 5, [](auto, auto) { return 0; })), mesh_(terrain_of(grid_)) {
    for (const TerrainVertex& vertex : mesh_.vertices) finer_.push_back(vertex.place);
  }

  MorphGuard guard() const {
    return MorphGuard(finer_, mesh_.triangles, mesh_.vertices, field_, placer_, 1);
  }

  HeightGrid grid_;
  TerrainMesh mesh_;
  SampleField field_ = field_of(grid_);
  std::vector<Place> finer_;
  ExactPlacer placer_;
};

TEST_F(FlatGuard, AllowsAVertexToMoveInsideItsStar) {
  EXPECT_TRUE(guard().allows(std::array{VertexId{12}}, cell(2.3, 2.1, 0.5)));
}

TEST_F(FlatGuard, RefusesToTurnATriangleOver) {
  EXPECT_FALSE(guard().allows(std::array{VertexId{12}}, cell(4, 1, 0)));
}

TEST_F(FlatGuard, RefusesToTurnATriangleOverInTheWorld) {
  // there the straight side from (0, 1) to (4, 1) passes 2 cells below (2, 1)
  const testing::BentPlacer bent(0.5);
  const std::vector<Place> places{cell(0, 1, 0), cell(4, 1, 0), cell(2, 4, 0)};
  std::vector<TerrainVertex> vertices;
  for (const Place& place : places) vertices.push_back({.place = place});
  const auto allows_in = [&](const Placer& world, double row) {
    return MorphGuard(places, {{1, 0, 2}}, vertices, field_, world, 1)
        .allows(std::array{VertexId{2}}, cell(2, row, 0));
  };
  EXPECT_TRUE(allows_in(placer_, 2.5));
  EXPECT_FALSE(allows_in(bent, 2.5));
  EXPECT_TRUE(allows_in(bent, 3.5));
}

TEST_F(FlatGuard, RefusesToLeaveTheTolerance) {
  EXPECT_FALSE(guard().allows(std::array{VertexId{12}}, cell(2, 2, 1.01)));
  EXPECT_TRUE(guard().allows(std::array{VertexId{12}}, cell(2, 2, 0.99)));
}

TEST_F(FlatGuard, RefusesToLeaveTheToleranceForAMoment) {
  // a peak of 1.01 m goes from between two samples over one, at t = 0.4, to between two
  finer_[12] = cell(1.6, 2, 1.01);
  EXPECT_FALSE(guard().allows(std::array{VertexId{12}}, cell(2.6, 2, 1.01)));
  finer_[12] = cell(1.6, 2, 0.99);
  EXPECT_TRUE(guard().allows(std::array{VertexId{12}}, cell(2.6, 2, 0.99)));
}

TEST_F(FlatGuard, MembersFollowTheVertexTheyWereJoinedTo) {
  MorphGuard joined = guard();
  joined.join(std::array{VertexId{12}, VertexId{13}}, VertexId{12});
  joined.join(std::array{VertexId{7}, VertexId{12}}, VertexId{7});
  EXPECT_EQ(joined.target_of(13), VertexId{7});
  EXPECT_EQ(joined.target_of(12), VertexId{7});
  EXPECT_EQ(joined.target_of(8), VertexId{8});
}

TEST_F(FlatGuard, CheckStaysWithEveryMemberAfterAJoin) {
  MorphGuard joined = guard();
  joined.join(std::array{VertexId{12}, VertexId{13}}, VertexId{12});
  // fine vertex 13 would be dragged across its neighbours to the far corner
  EXPECT_FALSE(joined.allows(std::array{VertexId{12}}, cell(0.5, 3.5, 0)));
}

TEST_F(FlatGuard, VerdictsDoNotDependOnWhatItRefusedBefore) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> aside(-0.9, 0.9), height_m(-1.2, 1.2);
  for (double& sample_m : field_.heights_m) sample_m = 0.5 * height_m(random);
  MorphGuard one = guard();
  int allowed = 0, refused = 0;
  for (int n = 0; n < 3000; ++n) {
    const std::uint32_t v = (n % 2 == 0 ? 6 : 12);
    const Place target = cell(v % 5 + aside(random), v / 5 + aside(random), height_m(random));
    const bool is_allowed = one.allows(std::array{VertexId{v}}, target);
    EXPECT_EQ(guard().allows(std::array{VertexId{v}}, target), is_allowed) << n;
    ++(is_allowed ? allowed : refused);
  }
  EXPECT_GT(allowed, 100);
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace terrane::hierarchy

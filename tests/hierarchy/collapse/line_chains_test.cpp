#include "hierarchy/collapse/line_chains.h"

#include <gmock/gmock.h>

namespace terrane::hierarchy {
namespace {

using ::testing::ElementsAre;

/// Line vertices at (column, row) in cells.
std::vector<TerrainVertex> at(std::initializer_list<std::pair<double, double>> places) {
  std::vector<TerrainVertex> vertices;
  for (const auto& [column, row] : places) {
    vertices.push_back({.place = {{static_cast<std::int32_t>(column * kUnitsPerCell),
                                   static_cast<std::int32_t>(-row * kUnitsPerCell)},
                                  0,
                                  {}},
                        .kind = VertexKind::kFeature});
  }
  return vertices;
}

constexpr VertexId v(std::uint32_t number) { return VertexId{number}; }

TEST(LineChains, AVertexGoesAlongTheLineWhileTheLineStaysNear) {
  const auto vertices = at({{0, 0}, {1, 0.2}, {2, 0}});
  const std::vector<LineEdge> edges{{0, 1}, {1, 2}};
  EXPECT_TRUE(LineChains(edges, 3, {.most_m = 0.2001}).may_drop(v(1), v(0), vertices));
  EXPECT_FALSE(LineChains(edges, 3, {.most_m = 0.1999}).may_drop(v(1), v(0), vertices));
  // rows are ten metres apart
  EXPECT_FALSE(LineChains(edges, 3, {.most_m = 1.999, .row_m = 10}).may_drop(v(1), v(2), vertices));
}

TEST(LineChains, DroppedVerticesAreRememberedSoThatErrorsDoNotAddUp) {
  // the middle vertex alone is near enough to the straight line, those dropped before are not
  const auto vertices = at({{0, 0}, {1, 0.9}, {2, 0.5}, {3, 0.9}, {4, 0}});
  LineChains chains(std::vector<LineEdge>{{0, 1}, {1, 2}, {2, 3}, {3, 4}}, 5, {.most_m = 0.7});
  ASSERT_TRUE(chains.may_drop(v(1), v(0), vertices));
  chains.drop(v(1), v(0), vertices);
  ASSERT_TRUE(chains.may_drop(v(3), v(4), vertices));
  chains.drop(v(3), v(4), vertices);
  EXPECT_TRUE(chains.joins(v(0), v(2)));
  EXPECT_FALSE(chains.joins(v(0), v(1)));
  EXPECT_FALSE(chains.may_drop(v(2), v(0), vertices));
  EXPECT_THAT(chains.edges(), ElementsAre(LineEdge{0, 2}, LineEdge{2, 4}));
}

TEST(LineChains, EndsAndJunctionsStay) {
  const auto vertices = at({{0, 0}, {1, 0}, {2, 0}, {1, 1}});
  const LineChains chains(std::vector<LineEdge>{{0, 1}, {1, 2}, {1, 3}}, 4, {.most_m = 100});
  EXPECT_FALSE(chains.may_drop(v(0), v(1), vertices));
  EXPECT_FALSE(chains.may_drop(v(1), v(0), vertices));
}

TEST(LineChains, LockedVerticesStay) {
  auto vertices = at({{0, 0}, {1, 0}, {2, 0}});
  vertices[1].kind = VertexKind::kLocked;
  const LineChains chains(std::vector<LineEdge>{{0, 1}, {1, 2}}, 3, {.most_m = 100});
  EXPECT_FALSE(chains.may_drop(v(1), v(0), vertices));
}

TEST(LineChains, TheLastThreeVerticesOfARingStay) {
  const auto vertices = at({{0, 0}, {1, 0}, {1, 1}, {0, 1}});
  LineChains chains(std::vector<LineEdge>{{0, 1}, {1, 2}, {2, 3}, {0, 3}}, 4, {.most_m = 100});
  ASSERT_TRUE(chains.may_drop(v(1), v(0), vertices));
  chains.drop(v(1), v(0), vertices);
  EXPECT_FALSE(chains.may_drop(v(2), v(0), vertices));
  EXPECT_EQ(chains.edges().size(), 3U);
}

}  // namespace
}  // namespace terrane::hierarchy

#include "ingest/grid_line.h"

#include <gtest/gtest.h>

#include <cmath>

namespace terrane::ingest {
namespace {

void expect_points(const std::vector<GridPosition>& line,
                   const std::vector<std::pair<double, double>>& wanted) {
  ASSERT_EQ(line.size(), wanted.size());
  for (std::size_t i = 0; i < line.size(); ++i) {
    EXPECT_NEAR(line[i].column, wanted[i].first, 1.0 / 16384) << i;
    EXPECT_NEAR(line[i].row, wanted[i].second, 1.0 / 16384) << i;
  }
}

TEST(LayOnGrid, AddsAPointAtEachColumnAndRow) {
  const std::vector<GridPosition> line{{0.5, 0.5}, {2.5, 1.5}};
  expect_points(lay_on_grid(line, {.snap_cells = 0}),
                {{0.5, 0.5}, {1, 0.75}, {1.5, 1}, {2, 1.25}, {2.5, 1.5}});
}

TEST(LayOnGrid, CrossingsLieExactlyOnTheirColumnOrRow) {
  const std::vector<GridPosition> line{{0.1, 0.3}, {9.7, 6.9}};
  const auto laid = lay_on_grid(line, {.snap_cells = 1.0 / 256});
  for (std::size_t i = 1; i + 1 < laid.size(); ++i) {
    EXPECT_TRUE(laid[i].column == std::round(laid[i].column) ||
                laid[i].row == std::round(laid[i].row));
  }
}

TEST(LayOnGrid, EachPieceLiesInOneClosedCell) {
  const std::vector<GridPosition> line{
      {0.001, 5.999}, {7.3, 0.2}, {7.3, 4.7}, {3, 3}, {0.2, 2.999}};
  const auto laid = lay_on_grid(line, {.snap_cells = 1.0 / 64});
  for (std::size_t i = 0; i + 1 < laid.size(); ++i) {
    const double column = std::floor((laid[i].column + laid[i + 1].column) / 2);
    const double row = std::floor((laid[i].row + laid[i + 1].row) / 2);
    for (const GridPosition& p : {laid[i], laid[i + 1]}) {
      EXPECT_TRUE(p.column >= column && p.column <= column + 1 && p.row >= row && p.row <= row + 1);
    }
  }
}

TEST(LayOnGrid, PointsNearASampleBecomeIt) {
  const std::vector<GridPosition> line{{1.003, 1.998}, {1.5, 1.5}};
  expect_points(lay_on_grid(line, {.snap_cells = 1.0 / 256}), {{1, 2}, {1.5, 1.5}});
  EXPECT_EQ(lay_on_grid(line, {.snap_cells = 1.0 / 256})[0].column, 1);
}

TEST(LayOnGrid, ALineThatShrinksToAPointIsGone) {
  const std::vector<GridPosition> line{{1.001, 1}, {0.999, 1}};
  EXPECT_TRUE(lay_on_grid(line, {.snap_cells = 1.0 / 256}).empty());
}

}  // namespace
}  // namespace terrane::ingest

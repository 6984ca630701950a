#include "ingest/separate_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/errors.h"
#include "ingest/grid_line.h"

namespace terrane::ingest {
namespace {

using Line = std::vector<GridPosition>;

// places 1/64 cell apart, a gap of half of that, cells of 10 m
constexpr LineRounding kRounding{.column_parts = 64, .row_parts = 64};
constexpr CellSize kCell{10, 10};
constexpr double kGap_m = 10.0 / 64 / 2;

void separate(std::vector<Line>& lines) {
  std::vector<Line*> all;
  for (Line& line : lines) {
    line = lay_on_grid(line, kRounding);
    all.push_back(&line);
  }
  separate_lines(all, kCell, kGap_m);
}

bool is_same(const GridPosition& a, const GridPosition& b) {
  return a.column == b.column && a.row == b.row;
}

bool passes(const Line& line, const GridPosition& place) {
  return std::ranges::any_of(line, [&](const GridPosition& p) { return is_same(p, place); });
}

double distance_m(const GridPosition& p, const GridPosition& a, const GridPosition& b) {
  const double dx = 10 * (b.column - a.column), dy = 10 * (b.row - a.row);
  const double px = 10 * (p.column - a.column), py = 10 * (p.row - a.row);
  const double t = std::clamp((px * dx + py * dy) / (dx * dx + dy * dy), 0.0, 1.0);
  return std::hypot(px - t * dx, py - t * dy);
}

TEST(SeparateLines, LeadsALineThroughABendThatItAlmostMeets) {
  // 0.44 / 64 cell below the bend of the other
  std::vector<Line> lines{{{1.5, 1.25}, {1.5, 1.5}, {1.75, 1.25}},
                          {{1.25, 1.5}, {1.8125, 1.5 + 1.0 / 64}}};
  separate(lines);
  EXPECT_EQ(lines[0].size(), 3U);
  EXPECT_TRUE(passes(lines[1], {1.5, 1.5}));
}

TEST(SeparateLines, GivesTwoThatCrossAPointInCommon) {
  std::vector<Line> lines{{{1.2, 1.3}, {1.8, 1.6}}, {{1.3, 1.7}, {1.7, 1.2}}};
  separate(lines);
  ASSERT_EQ(lines[0].size(), 3U);
  ASSERT_EQ(lines[1].size(), 3U);
  EXPECT_TRUE(is_same(lines[0][1], lines[1][1]));
  EXPECT_NEAR(lines[0][1].column, 1.514, 1.0 / 64);  // of the straight lines, by Cramer's rule
  EXPECT_NEAR(lines[0][1].row, 1.450, 1.0 / 64);
}

TEST(SeparateLines, LeavesOneThatIsFarFromAllAsItIs) {
  std::vector<Line> lines{{{0.25, 0.25}, {0.75, 0.5}, {0.5, 0.75}}};
  const Line before = lay_on_grid(lines[0], kRounding);
  separate(lines);
  ASSERT_EQ(lines[0].size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_TRUE(is_same(lines[0][i], before[i]));
}

class RandomTangles : public ::testing::TestWithParam<int> {};

TEST_P(RandomTangles, KeepTheGapWithinTheSumOfWhatTheyMayMove) {
  std::mt19937 random(static_cast<unsigned>(GetParam()));
  std::uniform_real_distribution<double> place(0, 5);
  std::vector<Line> lines(4);
  for (Line& line : lines) {
    for (int i = 0; i < 6; ++i) line.push_back({place(random), place(random)});
  }
  const std::vector<Line> before = lines;
  separate(lines);
  Line points;
  for (const Line& line : lines) points.insert(points.end(), line.begin(), line.end());
  for (int row = 0; row <= 5; ++row) {
    for (int column = 0; column <= 5; ++column) {
      points.push_back({static_cast<double>(column), static_cast<double>(row)});
    }
  }
  for (std::size_t k = 0; k < lines.size(); ++k) {
    for (std::size_t i = 0; i + 1 < lines[k].size(); ++i) {
      const GridPosition &a = lines[k][i], &b = lines[k][i + 1];
      for (const GridPosition& p : points) {
        if (is_same(p, a) || is_same(p, b)) continue;
        // points of the next cell are as far beyond a side as they are
        const bool is_on_side = a.column == b.column || a.row == b.row;
        if (is_on_side) continue;
        EXPECT_GE(distance_m(p, a, b), 0.99 * kGap_m);
      }
    }
    for (const GridPosition& p : lines[k]) {
      double off_m = INFINITY;
      for (std::size_t i = 0; i + 1 < before[k].size(); ++i) {
        off_m = std::min(off_m, distance_m(p, before[k][i], before[k][i + 1]));
      }
      // half a part on both axes, and a few gaps where a line is led aside more than once
      EXPECT_LE(off_m, 10.0 / 64 * 0.71 + 3 * kGap_m);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomTangles, ::testing::Range(0, 50));

}  // namespace
}  // namespace terrane::ingest

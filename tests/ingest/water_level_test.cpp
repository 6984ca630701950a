#include "ingest/water_level.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ingest/grid_line.h"

namespace terrane::ingest {
namespace {

/// Heights 10 column + row over 12 x 10 samples; one void.
class Slope final : public HeightSource {
 public:
  GridShape shape() const override { return {12, 10}; }
  HeightGrid read(const Window& window) const override {
    HeightGrid grid{window, {}};
    for (std::int64_t row = window.row; row < window.row + window.rows; ++row) {
      for (std::int64_t column = window.column; column < window.column + window.columns; ++column) {
        const bool is_void = column == 5 && row == 4;
        grid.heights_m.push_back(is_void ? kNoHeight : static_cast<float>(10 * column + row));
      }
    }
    return grid;
  }
};

std::vector<GridPosition> ring(std::vector<GridPosition> corners) {
  corners.push_back(corners.front());
  return lay_on_grid(corners, {.snap_cells = 1.0 / 256});
}

/// From (1.5, 1.5) to (8.5, 7), with an island from (4.5, 2.5) to (6.5, 4.5).
WaterBody lake(double height_m = 0) {
  return {{ring({{1.5, 1.5}, {8.5, 1.5}, {8.5, 7}, {1.5, 7}}),
           ring({{4.5, 2.5}, {6.5, 2.5}, {6.5, 4.5}, {4.5, 4.5}})},
          height_m};
}

std::int64_t count_inside(const WaterBody& body) {
  std::int64_t count = 0;
  for (std::int64_t row = -1; row <= 10; ++row) {
    for (const RowSpan& span : samples_inside(body, row)) count += span.last - span.first + 1;
  }
  return count;
}

TEST(SamplesInside, AreThoseWithinAndOnTheShoreWithoutIslands) {
  // columns 2 to 8, rows 2 to 7 (the last on the shore), less the island's 2 x 2
  EXPECT_EQ(count_inside(lake()), 7 * 6 - 4);
  const auto row = samples_inside(lake(), 3);
  ASSERT_EQ(row.size(), 2U);
  EXPECT_EQ(row[0].first, 2);
  EXPECT_EQ(row[0].last, 4);
  EXPECT_EQ(row[1].first, 7);
  EXPECT_EQ(row[1].last, 8);
}

TEST(SamplesInside, OfASlantedShoreAgreeWithItsEquation) {
  const WaterBody triangle{{ring({{0.3, 0.2}, {10.7, 3.1}, {2.9, 9.4}})}, 0};
  const auto left = [](GridPosition a, GridPosition b, double x, double y) {
    return (b.column - a.column) * (y - a.row) - (b.row - a.row) * (x - a.column) > 0;
  };
  for (std::int64_t row = 0; row < 10; ++row) {
    for (std::int64_t column = 0; column < 12; ++column) {
      const auto x = static_cast<double>(column), y = static_cast<double>(row);
      const bool wanted = left({0.3, 0.2}, {10.7, 3.1}, x, y) &&
                          left({10.7, 3.1}, {2.9, 9.4}, x, y) && left({2.9, 9.4}, {0.3, 0.2}, x, y);
      bool found = false;
      for (const RowSpan& span : samples_inside(triangle, row)) {
        found = found || (span.first <= column && column <= span.last);
      }
      EXPECT_EQ(found, wanted) << column << " " << row;
    }
  }
}

TEST(SamplesInside, TouchOnlyOnASampleIsThatSample) {
  const WaterBody diamond{{ring({{3, 1}, {5, 3}, {3, 5}, {1, 3}})}, 0};
  const auto top = samples_inside(diamond, 1);
  ASSERT_EQ(top.size(), 1U);
  EXPECT_EQ(top[0].first, 3);
  EXPECT_EQ(top[0].last, 3);
  EXPECT_EQ(count_inside(diamond), 1 + 3 + 5 + 3 + 1);
}

TEST(ShoreHeight, IsTheMedianOfTheSamplesBesideTheShore) {
  // a strip of columns 3 to 5 in row 6: 36, 46, 56
  const WaterBody strip{{ring({{2.5, 5.5}, {5.5, 5.5}, {5.5, 6.5}, {2.5, 6.5}})}, 0};
  EXPECT_EQ(shore_height_m(strip, Slope()), 46);
}

TEST(ShoreHeight, OfAPondBetweenSamplesIsThatOfThoseAround) {
  const WaterBody pond{{ring({{2.4, 5.4}, {2.6, 5.4}, {2.5, 5.6}})}, 0};
  EXPECT_EQ(shore_height_m(pond, Slope()), 26);  // of 25, 26, 35, 36 the lower middle
}

TEST(LevelWater, PutsSamplesInsideAndVoidsAtOneHeightAndLeavesTheRest) {
  WaterBody body = lake(7.5);
  body.shores.resize(1);  // without the island, so that the void is in the water
  const auto levelled = level_water(std::make_unique<Slope>(), water_rows({body}, {12, 10}));
  const HeightGrid whole = levelled->read({0, 0, 12, 10}), part = levelled->read({4, 3, 3, 2});
  for (std::int64_t row = 0; row < 10; ++row) {
    for (std::int64_t column = 0; column < 12; ++column) {
      const bool is_wet = column >= 2 && column <= 8 && row >= 2 && row <= 7;
      EXPECT_EQ(whole.at(column, row), is_wet ? 7.5F : static_cast<float>(10 * column + row));
    }
  }
  EXPECT_EQ(part.heights_m, std::vector<float>(6, 7.5F));
}

}  // namespace
}  // namespace terrane::ingest

#include "tiler/tile/inner_columns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace terrane::tiler {
namespace {

using hierarchy::FieldPoint;

constexpr double kMargin_cells = 0.3;
constexpr std::int64_t kSide = 40;

/// How far inside a triangle a sample is, from its nearest side; negative outside.
double depth_cells(const FieldPoint (&corners)[3], double column, double row) {
  double depth = INFINITY;
  for (int k = 0; k < 3; ++k) {
    const FieldPoint &p = corners[k], &q = corners[(k + 1) % 3], &r = corners[(k + 2) % 3];
    const auto beside = [&](double c, double w) {
      return ((q.row - p.row) * (c - p.column) - (q.column - p.column) * (w - p.row)) /
             std::hypot(q.row - p.row, q.column - p.column);
    };
    const double sign = beside(r.column, r.row) > 0 ? 1 : -1;
    depth = std::min(depth, sign * beside(column, row));
  }
  return depth;
}

void expect_exactly_the_inner_samples(const FieldPoint (&corners)[3]) {
  const InnerColumns inner(corners[0], corners[1], corners[2], kMargin_cells);
  for (std::int64_t row = 0; row < kSide; ++row) {
    const auto [first, last] = inner.of_row(row, 2, kSide - 1);
    for (std::int64_t column = 2; column < kSide; ++column) {
      const double spare =
          depth_cells(corners, static_cast<double>(column), static_cast<double>(row)) -
          kMargin_cells;
      if (std::abs(spare) < 1e-9) continue;  // by rounding
      EXPECT_EQ(column >= first && column <= last, spare > 0) << column << " " << row;
    }
  }
}

TEST(InnerColumns, AreTheSamplesAwayFromAllSides) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-10, kSide + 10);
  for (int k = 0; k < 300; ++k) {
    expect_exactly_the_inner_samples({{place(random), place(random), 0},
                                      {place(random), place(random), 0},
                                      {place(random), place(random), 0}});
  }
}

TEST(InnerColumns, AreSoBesideSidesAlongRowsAndColumns) {
  expect_exactly_the_inner_samples({{3, 5, 0}, {30, 5, 0}, {3, 31, 0}});
  expect_exactly_the_inner_samples({{3, 31, 0}, {30, 31, 0}, {30, 4, 0}});
  expect_exactly_the_inner_samples({{30, 31, 0}, {3, 31, 0}, {30, 4, 0}});
}

TEST(InnerColumns, AreNoneOfATriangleWithoutArea) {
  const InnerColumns inner({3, 5, 0}, {13, 15, 0}, {23, 25, 0}, kMargin_cells);
  const auto [first, last] = inner.of_row(10, 0, 39);
  EXPECT_GT(first, last);
}

}  // namespace
}  // namespace terrane::tiler

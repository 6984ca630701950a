#include "hierarchy/collapse/sample_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <vector>

namespace terrane::hierarchy {
namespace {

/// Is a point in the triangle, or nearer to one of its lines from outside than slack? By the three
/// signed distances.
bool is_near(const FieldPoint (&t)[3], double column, double row, double slack) {
  double turn = (t[1].column - t[0].column) * (t[2].row - t[0].row) -
                (t[1].row - t[0].row) * (t[2].column - t[0].column);
  for (int k = 0; k < 3; ++k) {
    const FieldPoint &p = t[k], &q = t[(k + 1) % 3];
    const double x = q.column - p.column, y = q.row - p.row;
    const double inside = (x * (row - p.row) - y * (column - p.column)) / std::hypot(x, y);
    if (std::copysign(1.0, turn) * inside < -slack) return false;
  }
  return true;
}

std::set<std::pair<float, float>> visited(const FieldPoint (&t)[3], const SampleField& field,
                                          double slack) {
  std::set<std::pair<float, float>> result;
  for_each_sample(t[0], t[1], t[2], field, slack, [&](std::size_t, const FieldSample& sample) {
    result.emplace(sample.column, sample.row);
    return true;
  });
  return result;
}

TEST(SampleField, AReducedFieldGivesExactlyTheKeptSamplesUnderATriangle) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> place(0, 99);
  std::uniform_real_distribution<double> corner(-5, 105);
  std::vector<FieldSample> kept;
  std::set<std::pair<float, float>> places;
  for (int i = 0; i < 400; ++i) {
    const auto column = static_cast<float>(place(random)), row = static_cast<float>(place(random));
    if (places.emplace(column, row).second) kept.push_back({column, row, 1});
  }
  for (const std::int64_t block : {2, 8, 64}) {
    SampleField field{100, 100, {}};
    field.keep(block, kept);
    for (int trial = 0; trial < 200; ++trial) {
      const FieldPoint triangle[3] = {{corner(random), corner(random), 0},
                                      {corner(random), corner(random), 0},
                                      {corner(random), corner(random), 0}};
      std::set<std::pair<float, float>> expected;
      for (const FieldSample& sample : kept) {
        if (is_near(triangle, sample.column, sample.row, 0.01)) {
          expected.emplace(sample.column, sample.row);
        }
      }
      EXPECT_EQ(visited(triangle, field, 0.01), expected) << "blocks of " << block;
    }
  }
}

/// Is a point in the convex hull? Where it is not, all points are to one side of a line through it.
bool is_in_hull(std::span<const FieldPoint> points, double column, double row) {
  std::vector<double> angles;
  for (const FieldPoint& p : points) angles.push_back(std::atan2(p.row - row, p.column - column));
  std::ranges::sort(angles);
  double widest = angles.front() + 2 * std::numbers::pi - angles.back();
  for (std::size_t k = 1; k < angles.size(); ++k) {
    widest = std::max(widest, angles[k] - angles[k - 1]);
  }
  return widest <= std::numbers::pi;
}

TEST(SampleField, SpansOfAHullAreItsSamplesAndNoOthers) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> corner(-5, 45);
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<FieldPoint> points(3 + static_cast<std::size_t>(trial) % 4);
    for (FieldPoint& p : points) p = {corner(random), corner(random), 0};
    const HullSides hull(points);
    std::set<std::pair<std::int64_t, std::int64_t>> found, expected;
    for_each_span_between(hull.sides(), {40, 40}, 1e-9,
                          [&](std::int64_t row, std::int64_t first, std::int64_t last) {
                            for (; first <= last; ++first) found.emplace(first, row);
                            return true;
                          });
    for (int k = 0; k < 1600; ++k) {
      if (is_in_hull(points, k % 40, k / 40)) expected.emplace(k % 40, k / 40);
    }
    EXPECT_EQ(found, expected) << trial;
  }
}

TEST(SampleField, AFullFieldLeavesOutWhereThereIsNoData) {
  SampleField field{3, 3, {1, 1, 1, 1, NAN, 1, 1, 1, 1}};
  const FieldPoint triangle[3] = {{-1, -1, 0}, {-1, 9, 0}, {9, -1, 0}};
  const auto found = visited(triangle, field, 1e-7);
  EXPECT_EQ(found.size(), 8U);
  EXPECT_FALSE(found.contains({1.0F, 1.0F}));
}

}  // namespace
}  // namespace terrane::hierarchy

#include "hierarchy/collapse/moving_triangle.h"

#include <gtest/gtest.h>

#include <random>

namespace terrane::hierarchy {
namespace {

using Triangle = std::array<FieldPoint, 3>;

FieldPoint blend(const FieldPoint& a, const FieldPoint& b, double t) {
  return {a.column + t * (b.column - a.column), a.row + t * (b.row - a.row),
          a.height_m + t * (b.height_m - a.height_m)};
}

double doubled_area(const FieldPoint& a, const FieldPoint& b, const FieldPoint& c) {
  // rows run downward, counter-clockwise is positive
  return (c.column - a.column) * (b.row - a.row) - (b.column - a.column) * (c.row - a.row);
}

Triangle blend(const Triangle& from, const Triangle& to, double t) {
  return {blend(from[0], to[0], t), blend(from[1], to[1], t), blend(from[2], to[2], t)};
}

/// Does it keep an area at all times?
bool stays_up(const Triangle& from, const Triangle& to) {
  for (int n = 0; n <= 100; ++n) {
    const Triangle at = blend(from, to, n / 100.0);
    if (doubled_area(at[0], at[1], at[2]) < 0.1) return false;
  }
  return true;
}

/// Largest distance at many moments at which the sample is under the triangle, or nearly.
double sampled_error_m(const Triangle& from, const Triangle& to, const FieldSample& sample,
                       double slack = 0) {
  constexpr int kMoments = 4000;
  const FieldPoint s{sample.column, sample.row, 0};
  double worst_m = 0;
  for (int n = 0; n <= kMoments; ++n) {
    const Triangle at = blend(from, to, double(n) / kMoments);
    const double whole = doubled_area(at[0], at[1], at[2]);
    if (!(whole > 1e-6)) continue;
    const double a = doubled_area(at[1], at[2], s) / whole;
    const double b = doubled_area(at[2], at[0], s) / whole;
    const double c = doubled_area(at[0], at[1], s) / whole;
    if (a < -slack || b < -slack || c < -slack) continue;
    worst_m = std::max(worst_m, std::abs(a * at[0].height_m + b * at[1].height_m +
                                         c * at[2].height_m - sample.height_m));
  }
  return worst_m;
}

struct Movement {
  Triangle from, to;
};

class RandomTriangles {
 public:
  Triangle next() {
    for (;;) {
      const Triangle t{point(), point(), point()};
      if (doubled_area(t[0], t[1], t[2]) > 0.5) return t;
    }
  }
  /// Keeps an area at all times; all three corners move, or two, or one.
  Movement next_movement() {
    for (;;) {
      Movement movement{next(), next()};
      const int moving = 1 + number_++ % 3;
      for (int k = moving; k < 3; ++k) movement.to[k] = movement.from[k];
      if (stays_up(movement.from, movement.to)) return movement;
    }
  }
  FieldPoint point() { return {uniform_(random_), uniform_(random_), 4 * uniform_(random_)}; }

 private:
  int number_ = 0;
  std::mt19937 random_{7};
  std::uniform_real_distribution<double> uniform_{0, 4};
};

TEST(MovingTriangle, AgreesWithALookAtManyMoments) {
  RandomTriangles random;
  int sound = 0, unsound = 0;
  for (int n = 0; n < 3000; ++n) {
    const auto [from, to] = random.next_movement();
    const FieldPoint s = random.point();
    const FieldSample sample{float(s.column), float(s.row), s.height_m};
    const double worst_m = sampled_error_m(from, to, sample);
    const MovingTriangle moving(from, to, 0);
    // a passage between two of the moments is one nearby at a moment
    const double nearby_m = sampled_error_m(from, to, sample, 0.003);
    EXPECT_TRUE(moving.stays_within(sample, nearby_m * 1.001 + 0.01)) << n;
    ++sound;
    // what lasts long is found; a moment at an edge is left to the neighbour
    if (worst_m < 0.5 || moving.stays_within(sample, worst_m * 0.9)) continue;
    ++unsound;
  }
  EXPECT_GT(sound, 1000);
  EXPECT_GT(unsound, 200);
}

TEST(MovingTriangle, FindsAPeakThatPassesBetweenQuarters) {
  // the peak at column 1.6 to 2.6 is nearest to column 2 at t = 0.4
  const Triangle from{FieldPoint{1.6, 2, 1.2}, {1, 3, 0}, {3, 2.9, 0}};
  const Triangle to{FieldPoint{2.6, 2, 1.2}, {1, 3, 0}, {3, 2.9, 0}};
  const FieldSample sample{2, 2.125F, 0};
  EXPECT_FALSE(MovingTriangle(from, to, 1e-7).stays_within(sample, 1));
  EXPECT_TRUE(MovingTriangle(from, to, 1e-7).stays_within(sample, 1.06));
}

TEST(MovingTriangle, ThatBecomesALineIsJudgedOnTheWay) {
  const Triangle from{FieldPoint{0, 4, 0}, {4, 4, 0}, {2, 0, 0}};
  const Triangle to{FieldPoint{4, 4, 3}, {4, 4, 3}, {2, 0, 0}};
  const FieldSample sample{2.9F, 2, 0};
  const double worst_m = sampled_error_m(from, to, sample);
  EXPECT_GT(worst_m, 0.5);
  EXPECT_TRUE(MovingTriangle(from, to, 0).stays_within(sample, worst_m * 1.01));
  EXPECT_FALSE(MovingTriangle(from, to, 0).stays_within(sample, worst_m * 0.95));
}

TEST(MovingTriangle, AgreesOverAFieldWithALookAtOneSampleAfterTheOther) {
  RandomTriangles random;
  int sound = 0, unsound = 0;
  for (int n = 0; n < 3000; ++n) {
    const auto [from, to] = random.next_movement();
    const double tolerance_m = 2 + random.point().column;
    SampleField field{5, 5, {}};
    for (int k = 0; k < 25; ++k) field.heights_m.push_back(random.point().height_m / 4 + 6);
    const MovingTriangle moving(from, to, field.slack_cells);
    bool is_each_near = true;
    for (int k = 0; k < 25; ++k) {
      const FieldSample sample{float(k % 5), float(k / 5), field.heights_m[std::size_t(k)]};
      is_each_near = is_each_near && moving.stays_within(sample, tolerance_m);
      // what surely leaves is seen to leave
      EXPECT_TRUE(!moving.surely_leaves(sample, tolerance_m) || !is_each_near) << n;
    }
    EXPECT_EQ(moving.stays_within(field, tolerance_m), is_each_near) << n;
    const std::optional<FieldSample> left = moving.find_left(field, tolerance_m);
    EXPECT_TRUE(!left || !moving.stays_within(*left, tolerance_m)) << n;
    ++(is_each_near ? sound : unsound);
  }
  EXPECT_GT(sound, 300);
  EXPECT_GT(unsound, 300);
}

TEST(MovingTriangle, SlabsChangeNoVerdict) {
  RandomTriangles random;
  int sound = 0, unsound = 0;
  for (int n = 0; n < 6000; ++n) {
    const auto [from, to] = random.next_movement();
    const double tolerance_m = 3 + random.point().column;
    // with a slack, samples beside short sides count from farther away than those beside long ones
    SampleField field{.columns = 9, .rows = 9, .heights_m = {}, .slack_cells = 0.3};
    for (int k = 0; k < 81; ++k) field.heights_m.push_back(random.point().height_m / 4 + 6);
    const MovingTriangle moving(from, to, field.slack_cells);
    const bool stays = moving.stays_within(field, tolerance_m);
    field.slabs = field.slabs_of_grid(4);
    EXPECT_EQ(moving.stays_within(field, tolerance_m), stays) << n;
    ++(stays ? sound : unsound);
  }
  EXPECT_GT(sound, 300);
  EXPECT_GT(unsound, 300);
}

TEST(MovingTriangle, SurelyLeavesNothingAsLongAsItStands) {
  const Triangle triangle{FieldPoint{0, 4, 0}, {4, 4, 0}, {2, 0, 0}};
  Triangle raised = triangle;
  raised[2].height_m = 0.1;
  EXPECT_FALSE(MovingTriangle(triangle, triangle, 0).surely_leaves({2, 2, 9}, 1));
  EXPECT_TRUE(MovingTriangle(triangle, raised, 0).surely_leaves({2, 2, 9}, 1));
}

TEST(MovingTriangle, SeesEverySampleOnItsWay) {
  // sweeps over (5, 1), which is under neither end
  SampleField field{8, 4, std::vector<double>(32, 0.0)};
  field.heights_m[1 * 8 + 4] = 100;
  const Triangle from{FieldPoint{0, 2, 0}, {2, 2, 0}, {1, 0, 0}};
  const Triangle to{FieldPoint{5, 2, 0}, {7, 2, 0}, {6, 0, 0}};
  EXPECT_FALSE(MovingTriangle(from, to, 1e-7).stays_within(field, 1));
  EXPECT_TRUE(MovingTriangle(from, to, 1e-7).stays_within(field, 101));
}

}  // namespace
}  // namespace terrane::hierarchy

#include "hierarchy/volume/grid_field.h"

#include <gmock/gmock.h>

#include <random>

#include "core/errors.h"
#include "tests/hierarchy/volume/test_surfaces.h"

namespace terrane::hierarchy::volume {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

constexpr MaterialId kAny{0};
const TetraCorners kCell = {Vector3d(0.1, 0.2, 0.1), Vector3d(2.9, 0.3, 0.2),
                            Vector3d(0.4, 2.8, 0.3), Vector3d(0.5, 0.6, 2.7)};

std::vector<double> posts(int count) {
  std::vector<double> axis;
  for (int i = 0; i < count; ++i) axis.push_back(i);
  return axis;
}

template <class F>
GridField sampled(const F& f, DeviationRule rule = DeviationRule::kEverywhere) {
  std::vector<double> values;
  for (int k = 0; k < 4; ++k) {
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 4; ++i) values.push_back(f(Vector3d(i, j, k)));
    }
  }
  return {{posts(4), posts(4), posts(4)}, {values}, rule};
}

LinearCell interpolant(const GridField& field) {
  LinearCell cell{kCell, {}};
  for (int k = 0; k < 4; ++k) cell.values[k] = field.value(kCell[k], kAny);
  return cell;
}

TEST(GridField, IsTrilinearBetweenPostsAndLevelBeyond) {
  const auto f = [](const Vector3d& p) { return 1 + 2 * p.x() - p.y() + p.x() * p.y() * p.z(); };
  const GridField field = sampled(f);
  EXPECT_NEAR(field.value({1.25, 2.5, 0.75}, kAny), f({1.25, 2.5, 0.75}), 1e-12);
  EXPECT_NEAR(field.value({7, 1, 1}, kAny), f({3, 1, 1}), 1e-12);
}

TEST(GridField, ALinearFieldDeviatesNowhere) {
  const GridField field = sampled([](const Vector3d& p) { return 3 * p.x() - 2 * p.z(); });
  EXPECT_NEAR(field.largest_deviation(interpolant(field), kAny, {}, 0), 0, 1e-12);
}

// 20,000 places each: none may deviate more, and the bound is to be of use
TEST(GridField, TheDeviationIsABoundAndNotALooseOne) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> value(0, 1);
  for (int round = 0; round < 5; ++round) {
    const GridField field = sampled([&](const Vector3d&) { return value(random); });
    const LinearCell cell = interpolant(field);
    const double bound = field.largest_deviation(cell, kAny, {}, 0);
    const Barycentric shape(kCell);
    double largest = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vector3d p = testing::random_point(Box{Vector3d(0, 0, 0), Vector3d(3, 3, 3)}, random);
      const Eigen::Vector4d w = shape.weights(p);
      if (w.minCoeff() < 0) continue;
      largest = std::max(largest, std::abs(field.value(p, kAny) - w.dot(cell.values)));
    }
    EXPECT_LE(largest, bound);
    EXPECT_GE(largest, bound / 2);
  }
}

TEST(GridField, PublishedDeviationLooksAtPostsOnly) {
  const auto bump = [](const Vector3d& p) { return p == Vector3d(1, 1, 0) ? 5.0 : 0.0; };
  const GridField field = sampled(bump, DeviationRule::kNativePoints);
  const LinearCell cell{
      {Vector3d(0.5, 0.5, -1), Vector3d(2.5, 0.5, -1), Vector3d(0.5, 2.5, -1), Vector3d(1, 1, 0.5)},
      Eigen::Vector4d::Zero()};
  EXPECT_DOUBLE_EQ(field.largest_deviation(cell, kAny, {}, 0), 5);
  LinearCell beside = cell;
  for (Vector3d& corner : beside.corners) corner.z() -= 0.6;
  EXPECT_DOUBLE_EQ(field.largest_deviation(beside, kAny, {}, 0), 0);
}

TEST(GridField, RefusesNanAndSaysWhere) {
  std::vector<double> values(8, 1.0);
  values[5] = NAN;
  try {
    GridField({posts(2), posts(2), posts(2)}, {values});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("(1, 0, 1)"));
  }
}

}  // namespace
}  // namespace terrane::hierarchy::volume

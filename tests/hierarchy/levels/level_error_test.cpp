#include "hierarchy/levels/level_error.h"

#include <gtest/gtest.h>

#include "hierarchy/levels/build_levels.h"
#include "tests/hierarchy/levels/test_surfaces.h"

namespace terrane::hierarchy {
namespace {

TEST(LevelError, DistanceFromATriangleIsToItsPlaneItsSideOrItsCorner) {
  const Eigen::Vector3d a(0, 0, 0), b(2, 0, 0), c(0, 2, 0);
  EXPECT_DOUBLE_EQ(squared_distance({0.5, 0.5, 3}, a, b, c), 9);
  EXPECT_DOUBLE_EQ(squared_distance({1, -2, 0}, a, b, c), 4);
  EXPECT_DOUBLE_EQ(squared_distance({-3, -4, 0}, a, b, c), 25);
  EXPECT_DOUBLE_EQ(squared_distance({2, 2, 1}, a, b, c), 3);
  EXPECT_DOUBLE_EQ(squared_distance({1, 0, 0}, a, a, a + b), 0);
}

TEST(LevelError, OfM0IsZero) {
  const LevelSequence sequence = build_levels(testing::saddle(17, 17));
  const LevelErrorMeter meter(sequence);
  const LevelError error = meter.measure(testing::mesh_at(sequence, 0), 0);
  EXPECT_EQ(error.max, 0);
  ASSERT_TRUE(error.vertical);
  EXPECT_EQ(error.vertical->max, 0);
  EXPECT_EQ(error.vertical->uncovered, 0U);
  EXPECT_EQ(error.vertical->folded, 0U);
}

TEST(LevelError, IsTheNearestOfAllTriangles) {
  const LevelSequence sequence = build_levels(testing::torus(14, 11), {.most_levels = 5});
  const LevelErrorMeter meter(sequence);
  const SurfaceMesh last = testing::mesh_at(sequence, sequence.level_count());
  double max2 = 0, sum2 = 0;
  for (const Eigen::Vector3d& p : meter.finest().points) {
    double nearest2 = 1e9;
    for (const auto& [a, b, c] : last.triangles) {
      nearest2 =
          std::min(nearest2, squared_distance(p, last.points[a], last.points[b], last.points[c]));
    }
    max2 = std::max(max2, nearest2);
    sum2 += nearest2;
  }
  const LevelError error = meter.measure(last, sequence.level_count());
  EXPECT_DOUBLE_EQ(error.max, std::sqrt(max2));
  EXPECT_NEAR(error.rms, std::sqrt(sum2 / static_cast<double>(meter.finest().points.size())),
              1e-12);
  EXPECT_FALSE(error.vertical) << "a torus is no height field";
}

TEST(LevelError, CountsWhatALevelLeavesUncoveredAndFolded) {
  const LevelSequence sequence =
      build_levels(testing::sheet(5, 5, [](double, double) { return 1.0; }), {.most_levels = 0});
  const LevelErrorMeter meter(sequence);
  SurfaceMesh mesh = testing::mesh_at(sequence, 0);
  for (Eigen::Vector3d& p : mesh.points) p.z() += 0.5;
  std::swap(mesh.triangles[7][0], mesh.triangles[7][1]);
  EXPECT_EQ(meter.measure(mesh, 0).vertical->folded, 1U);
  EXPECT_NEAR(meter.measure(mesh, 0).vertical->rms, 0.5, 1e-6);
  // without the triangles at a corner of the square
  const Eigen::Vector3d low(-1, -1, 1.5);
  std::erase_if(mesh.triangles, [&](const Corners& corners) {
    return std::ranges::any_of(corners,
                               [&](auto v) { return (mesh.points[v] - low).norm() < 1e-6; });
  });
  EXPECT_EQ(meter.measure(mesh, 0).vertical->uncovered, 1U);
}

}  // namespace
}  // namespace terrane::hierarchy

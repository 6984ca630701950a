#include "hierarchy/volume/piece_distance.h"

#include <gtest/gtest.h>

#include "tests/hierarchy/volume/test_surfaces.h"

namespace terrane::hierarchy::volume {
namespace {

using Eigen::Vector3d;

const Box kBox{{-2, -2, -2}, {2, 2, 2}};

ZeroSet piece_of(const std::vector<Vector3d>& points) {
  ZeroSet piece;
  piece.size = static_cast<int>(points.size());
  std::ranges::copy(points, piece.points.begin());
  return piece;
}

// half of an inscribed square: corners on the sphere, the longest side through its middle; the
// centre of the piece is 2/3 away
TEST(LargestDistance, FindsWhatLiesBetweenCornersAndCentre) {
  const InterfaceSurface sphere("sphere", testing::sphere(Vector3d::Zero(), 1, 5),
                                SideRule::kNormals, kBox);
  const ZeroSet half = piece_of({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}});
  EXPECT_NEAR(std::sqrt(sphere.nearest({0, 1.0 / 3, 0}).squared_distance), 2.0 / 3, 0.01);
  EXPECT_GT(largest_distance(half, sphere, 0.9), 0.9);
  EXPECT_LE(largest_distance(half, sphere, 1.05), 1.05);
  const ZeroSet square = piece_of({{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}});
  EXPECT_GT(largest_distance(square, sphere, 0.9), 0.9);
}

TEST(LargestDistance, IsABoundAndNotALooseOne) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> height(-0.3, 0.3), near(-0.5, 0.5);
  const InterfaceSurface ground(
      "ground", testing::heights(-3, 3, 24, [&](double, double) { return height(random); }),
      SideRule::kVertical, kBox);
  int within = 0;
  for (int round = 0; round < 300; ++round) {
    ZeroSet piece;
    piece.size = 3;
    for (int k = 0; k < 3; ++k) {
      piece.points[k] = testing::random_point(kBox, random);
      piece.points[k].z() = near(random);
    }
    double largest = 0;
    for (int i = 0; i < 500; ++i) {
      const Vector3d p =
          testing::random_point({piece.points[0], piece.points[1], piece.points[2]}, random);
      largest = std::max(largest, std::sqrt(ground.nearest(p).squared_distance));
    }
    const double good_enough = 0.4;
    const double bound = largest_distance(piece, ground, good_enough);
    if (bound > good_enough) {
      EXPECT_GT(largest, 0.3);  // undecided only where it is close
      continue;
    }
    ++within;
    EXPECT_LE(largest, bound + 1e-12);
  }
  EXPECT_GT(within, 50);
  EXPECT_LT(within, 250);
}

TEST(LargestDistance, TakesPiecesWithoutExtent) {
  const InterfaceSurface cube("cube", testing::cube(-1, 1), SideRule::kNormals, kBox);
  EXPECT_EQ(largest_distance({}, cube, 1), 0);
  EXPECT_NEAR(largest_distance(piece_of({{1.5, 0, 0}}), cube, 1), 0.5, 1e-12);
  EXPECT_NEAR(largest_distance(piece_of({{1.5, 0, 0}, {1.25, 0.5, 0}}), cube, 1), 0.5, 1e-12);
}

}  // namespace
}  // namespace terrane::hierarchy::volume

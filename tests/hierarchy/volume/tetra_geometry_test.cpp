#include "hierarchy/volume/tetra_geometry.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <random>

#include "tests/hierarchy/volume/test_surfaces.h"

namespace terrane::hierarchy::volume {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

const TetraCorners kUnit = {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0),
                            Vector3d(0, 0, 1)};

double area(const SmallPolygon& polygon) {
  double twice = 0;
  for (int k = 1; k + 1 < polygon.size; ++k) {
    twice += (polygon.points[k] - polygon.points[0])
                 .cross(polygon.points[k + 1] - polygon.points[0])
                 .norm();
  }
  return twice / 2;
}

double share(const SubTetra& tetra) { return std::abs(tetra.determinant()); }

TEST(Barycentric, WeightsAreOneAtTheirCornerAndGradientsLeadToIt) {
  const Barycentric unit(kUnit);
  EXPECT_DOUBLE_EQ(unit.volume(), 1.0 / 6);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(unit.weights(kUnit[k]), Vector4d::Unit(k));
  EXPECT_EQ(unit.gradient(0), Vector3d(-1, -1, -1));
  EXPECT_EQ(unit.gradient(3), Vector3d(0, 0, 1));
}

TEST(Clip, KeepsAllOfATriangleInsideAndNothingOfOneOutside) {
  const Barycentric unit(kUnit);
  EXPECT_EQ(clip({Vector3d(.1, .1, .1), Vector3d(.3, .1, .1), Vector3d(.1, .3, .1)}, unit).size, 3);
  EXPECT_EQ(clip({Vector3d(2, 2, 2), Vector3d(3, 2, 2), Vector3d(2, 3, 2)}, unit).size, 0);
  // near the corner (1,0,0), but beyond the slanted face: no single face tells
  EXPECT_EQ(clip({Vector3d(.9, .3, -.1), Vector3d(.9, .3, .3), Vector3d(1.2, -.1, .2)}, unit).size,
            0);
}

// a large triangle in the plane z = h cuts out the triangle with legs 1 - h
TEST(Clip, CutsTheSectionOutOfALargeTriangle) {
  const double h = 0.25;
  const SmallPolygon section =
      clip({Vector3d(-9, -9, h), Vector3d(30, -9, h), Vector3d(-9, 30, h)}, Barycentric(kUnit));
  EXPECT_NEAR(area(section), (1 - h) * (1 - h) / 2, 1e-7);
}

TEST(Clip, ATriangleInTheFaceBetweenTwoCellsIsInBoth) {
  const std::array<Vector3d, 3> flat = {Vector3d(.1, .1, 0), Vector3d(.3, .1, 0),
                                        Vector3d(.1, .3, 0)};
  const TetraCorners under = {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0),
                              Vector3d(0, 0, -1)};
  EXPECT_EQ(clip(flat, Barycentric(kUnit)).size, 3);
  EXPECT_EQ(clip(flat, Barycentric(under)).size, 3);
}

TEST(ZeroSet, IsAPointAnEdgeATriangleOrAQuadrangle) {
  EXPECT_TRUE(zero_set(kUnit, {1, 2, 3, 4}).is_empty());
  EXPECT_EQ(zero_set(kUnit, {0, 2, 3, 4}).size, 1);
  EXPECT_EQ(zero_set(kUnit, {0, 0, 3, 4}).size, 2);
  EXPECT_EQ(zero_set(kUnit, {-1, 2, 3, 4}).size, 3);
  EXPECT_EQ(zero_set(kUnit, {0, -1, 3, 4}).size, 3);
  EXPECT_EQ(zero_set(kUnit, {-1, -1, 1, 1}).size, 4);
}

// z = 1/2 in the unit tetrahedron: the triangle with legs 1/2
TEST(ZeroSet, DistanceIsThatToTheSectionNotToItsPlane) {
  const ZeroSet section = zero_set(kUnit, {-1, -1, -1, 1});
  EXPECT_NEAR(section.distance({0.1, 0.1, 0.9}), 0.4, 1e-15);
  EXPECT_NEAR(section.distance({1.5, 0, 0.5}), 1, 1e-15);
  // x + y = 1/2 is a quadrangle: its corners go around
  const ZeroSet quadrangle = zero_set(kUnit, {-1, 1, 1, -1});
  EXPECT_NEAR(quadrangle.distance({0.2, 0.2, 0.3}), 0.1 / std::sqrt(2), 1e-15);
}

TEST(Cut, PartsFillTheWholeAndLieOnTheirSides) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(-1, 1);
  for (int i = 0; i < 500; ++i) {
    const Vector4d f(value(random), value(random), value(random), i % 5 == 0 ? 0 : value(random));
    std::vector<SubTetra> below, above;
    cut(SubTetra::Identity(), f, below, above);
    double sum = 0;
    for (const SubTetra& t : below) {
      sum += share(t);
      EXPECT_LE((t.transpose() * f).maxCoeff(), 1e-12);
    }
    for (const SubTetra& t : above) {
      sum += share(t);
      EXPECT_GE((t.transpose() * f).minCoeff(), -1e-12);
    }
    EXPECT_NEAR(sum, 1, 1e-12);
  }
}

// the corner that a plane cuts off at half of each edge is an eighth of the tetrahedron
TEST(Cut, AHalvedCornerIsAnEighth) {
  std::vector<SubTetra> below, above;
  cut(SubTetra::Identity(), {-1, 1, 1, 1}, below, above);
  ASSERT_EQ(below.size(), 1);
  EXPECT_NEAR(share(below[0]), 1.0 / 8, 1e-15);
}

}  // namespace
}  // namespace terrane::hierarchy::volume

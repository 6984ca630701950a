#include "hierarchy/volume/interface_surface.h"

#include <gmock/gmock.h>

#include "core/errors.h"
#include "tests/hierarchy/volume/test_surfaces.h"

namespace terrane::hierarchy::volume {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

const Box kBox{Vector3d(-2, -2, -2), Vector3d(2, 2, 2)};

InterfaceSurface closed(SurfaceMesh mesh) {
  return {"body.obj", std::move(mesh), SideRule::kNormals, kBox};
}

std::string refusal(SurfaceMesh mesh, SideRule side = SideRule::kNormals) {
  try {
    InterfaceSurface("body.obj", std::move(mesh), side, kBox);
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("body.obj: "));
    return error.what();
  }
  return "accepted";
}

// the signed distance to a cube is known in closed form
double distance_to_cube(const Vector3d& p, double half) {
  const Vector3d q = p.cwiseAbs().array() - half;
  return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
}

TEST(InterfaceSurface, DistanceToACubeIsExactInsideAndOutsideAtFacesEdgesAndCorners) {
  const InterfaceSurface cube = closed(testing::cube(-1, 1));
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    const Vector3d p = testing::random_point(kBox, random);
    EXPECT_NEAR(cube.signed_distance(p, DistanceRule::kExact), distance_to_cube(p, 1), 1e-12);
  }
}

TEST(InterfaceSurface, NearestTriangleOfTheTreeIsThatOfALookAtAll) {
  const SurfaceMesh mesh = testing::sphere({0.1, 0.2, -0.1}, 1.1, 3);
  const InterfaceSurface surface = closed(mesh);
  std::mt19937 random(2);
  for (int i = 0; i < 300; ++i) {
    const Vector3d p = testing::random_point(kBox, random);
    double nearest = 1e300, vertex = 1e300;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      nearest = std::min(nearest, closest_point(p, surface.corners(t)).squared_distance);
    }
    for (const Vector3d& v : mesh.points) vertex = std::min(vertex, (v - p).squaredNorm());
    EXPECT_DOUBLE_EQ(surface.nearest(p).squared_distance, nearest);
    EXPECT_DOUBLE_EQ((mesh.points[surface.nearest_vertex(p)] - p).squaredNorm(), vertex);
  }
}

// beside the middle of a face of 2 x 2 the face is 0.1 away; the nearest corner is far more, and
// its normal (1,1,1) points away from there: on so coarse a mesh even the published sign is wrong
TEST(InterfaceSurface, PublishedDistanceIsThatOfTheNearestVertexWithItsNormalsSign) {
  const InterfaceSurface cube = closed(testing::cube(-1, 1));
  const Vector3d beside(0.05, 0.05, 1.1), before(1.2, 1.1, 1.3);
  EXPECT_NEAR(cube.signed_distance(beside, DistanceRule::kExact), 0.1, 1e-12);
  EXPECT_NEAR(cube.signed_distance(beside, DistanceRule::kNearestVertex),
              -(beside - Vector3d(1, 1, 1)).norm(), 1e-12);
  EXPECT_NEAR(cube.signed_distance(before, DistanceRule::kNearestVertex),
              (before - Vector3d(1, 1, 1)).norm(), 1e-12);
}

TEST(InterfaceSurface, HeightsAreInterpolatedAndTellTheSide) {
  const InterfaceSurface ground(
      "dem", testing::heights(-3, 3, 60, [](double x, double y) { return 0.3 * x - 0.1 * y; }),
      SideRule::kVertical, kBox);
  EXPECT_NEAR(*ground.height(0.123, 1.71), 0.3 * 0.123 - 0.1 * 1.71, 1e-12);
  EXPECT_FALSE(ground.height(3.1, 0).has_value());
  const double slant = std::sqrt(1 + 0.09 + 0.01);
  EXPECT_NEAR(ground.signed_distance({0, 0, 0.5}, DistanceRule::kExact), 0.5 / slant, 1e-12);
  EXPECT_NEAR(ground.signed_distance({0, 0, -0.5}, DistanceRule::kExact), -0.5 / slant, 1e-12);
}

TEST(InterfaceSurface, RefusesAnOpenMeshAndSaysWhere) {
  SurfaceMesh open = testing::cube(-1, 1);
  open.triangles.pop_back();
  EXPECT_THAT(refusal(open), HasSubstr("ends inside the box"));
}

TEST(InterfaceSurface, TakesAMeshThatIsOpenOutsideTheBox) {
  SurfaceMesh trough = testing::cube(-1, 1);
  for (Vector3d& p : trough.points) p.x() *= 5;
  trough.triangles.resize(10);  // without the wall at x = 5
  EXPECT_EQ(refusal(trough), "accepted");
}

TEST(InterfaceSurface, RefusesAMeshThatIntersectsItself) {
  SurfaceMesh two = testing::cube(-1, 0.5);
  const SurfaceMesh other = testing::cube(0.1, 1);
  for (const auto& t : other.triangles) two.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  two.points.insert(two.points.end(), other.points.begin(), other.points.end());
  EXPECT_THAT(refusal(two), HasSubstr("intersects itself"));
}

TEST(InterfaceSurface, RefusesTrianglesOfDifferentOrientation) {
  SurfaceMesh mesh = testing::cube(-1, 1);
  std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
  EXPECT_THAT(refusal(mesh), HasSubstr("Orient the mesh"));
}

TEST(InterfaceSurface, RefusesAnEdgeOfThreeTriangles) {
  SurfaceMesh mesh = testing::cube(-1, 1);
  mesh.points.emplace_back(3, 3, 3);
  mesh.triangles.push_back({0, 1, 8});
  EXPECT_THAT(refusal(mesh), HasSubstr("3 triangles meet"));
}

TEST(InterfaceSurface, RefusesACoordinateThatIsNoNumber) {
  SurfaceMesh mesh = testing::cube(-1, 1);
  mesh.points[5].y() = NAN;
  EXPECT_THAT(refusal(mesh), HasSubstr("vertex 5"));
}

TEST(InterfaceSurface, RefusesASurfaceThatTheBoxMisses) {
  EXPECT_THAT(refusal(testing::cube(5, 6)), HasSubstr("outside the box"));
}

TEST(InterfaceSurface, RefusesHeightsThatOverhang) {
  SurfaceMesh ground = testing::heights(-3, 3, 4, [](double, double) { return 0; });
  ground.points[12].x() += 2;
  EXPECT_THAT(refusal(ground, SideRule::kVertical), HasSubstr("overhangs"));
}

}  // namespace
}  // namespace terrane::hierarchy::volume

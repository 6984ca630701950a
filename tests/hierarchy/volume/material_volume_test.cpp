#include "hierarchy/volume/material_volume.h"

#include <gmock/gmock.h>

#include <Eigen/LU>

#include "core/errors.h"
#include "hierarchy/volume/grid_field.h"
#include "tests/hierarchy/volume/test_surfaces.h"

namespace terrane::hierarchy::volume {
namespace {

using Eigen::Vector3d;

const Box kBox{Vector3d(0, 0, 0), Vector3d(10, 10, 10)};
constexpr InterfaceId kBall{0};
constexpr MaterialId kIn{0}, kOut{1};
constexpr FieldId kDensity{0};
constexpr double kRadius = 3.3;
const Vector3d kCentre(5.1, 4.8, 5.3);
constexpr double kAnything = std::numeric_limits<double>::infinity();

std::shared_ptr<const InterfaceSurface> ball(const Vector3d& centre = kCentre,
                                             double radius = kRadius) {
  return std::make_shared<InterfaceSurface>("ball", testing::sphere(centre, radius, 3),
                                            SideRule::kNormals, kBox);
}

// inside and outside two different smooth functions: a jump everywhere on the ball
std::shared_ptr<const Field> density() {
  std::vector<double> axis, inside, outside;
  for (int i = 0; i <= 10; ++i) axis.push_back(i);
  for (int k = 0; k <= 10; ++k) {
    for (int j = 0; j <= 10; ++j) {
      for (int i = 0; i <= 10; ++i) {
        inside.push_back(100 + 2 * i + 0.3 * j * k);
        outside.push_back(20 + 0.2 * (i - 5) * (i - 5) - k);
      }
    }
  }
  return std::make_shared<GridField>(std::array{axis, axis, axis},
                                     std::vector<std::vector<double>>{inside, outside});
}

VolumeModel ball_model() {
  return {kBox, {ball()}, {{"in", {{kBall, true}}}, {"out", {}}}, {{"density", "", density()}}};
}

void expect_interface_within(const MaterialVolume& volume, InterfaceId id, double tolerance,
                             int points) {
  // all pieces of the approximation, wherever they are: the judge knows no cells
  std::vector<ZeroSet> pieces;
  volume.mesh().for_each_leaf([&](CellId leaf) {
    const ZeroSet piece = volume.approximation(leaf, id);
    if (!piece.is_empty()) pieces.push_back(piece);
  });
  ASSERT_FALSE(pieces.empty());
  const InterfaceSurface& surface = *volume.model().interfaces[index(id)];
  std::mt19937 random(6);
  double largest = 0;
  for (int i = 0; i < points; ++i) {
    const auto t = static_cast<std::uint32_t>(random() % surface.mesh().triangles.size());
    const Vector3d p = testing::random_point(surface.corners(t), random);
    double nearest = kAnything;
    for (const ZeroSet& piece : pieces) nearest = std::min(nearest, piece.distance(p));
    largest = std::max(largest, nearest);
  }
  EXPECT_LE(largest, tolerance);
}

void expect_fields_within(const MaterialVolume& volume, double tolerance, int points) {
  std::mt19937 random(7);
  for (int i = 0; i < points; ++i) {
    const Vector3d p = testing::random_point(kBox, random);
    const auto [leaf, weights] = volume.mesh().locate(p);
    const MaterialId material = volume.true_material(p);
    const double error = std::abs(weights.dot(volume.values(leaf, kDensity, material)) -
                                  volume.model().fields[0].field->value(p, material));
    ASSERT_LE(error, volume.field_error(leaf, kDensity) + 1e-9);
    ASSERT_LE(error, tolerance + 1e-9);
  }
}

TEST(MaterialVolume, KeepsTheInterfaceWithinItsTolerance) {
  for (const double tolerance : {0.4, 0.2}) {
    MaterialVolume volume(ball_model());
    EXPECT_TRUE(volume.refine({{tolerance}, {kAnything}}));
    expect_interface_within(volume, kBall, tolerance, 200);
  }
}

TEST(MaterialVolume, KeepsTheFieldOfTheTrueMaterialWithinItsToleranceAtEveryPlace) {
  MaterialVolume volume(ball_model());
  EXPECT_TRUE(volume.refine({{0.4}, {4.0}}));
  expect_fields_within(volume, 4.0, 20000);
}

// the ball, within what a shell as thick as the tolerance holds (and 2 %: it is a polyhedron)
TEST(MaterialVolume, PiecesFillTheBoxAndTheBall) {
  MaterialVolume volume(ball_model());
  volume.refine({{0.2}, {kAnything}});
  std::array<double, 2> sum = {};
  volume.mesh().for_each_leaf([&](CellId leaf) {
    const double cell = Barycentric(volume.corners(leaf)).volume();
    for (const Piece& piece : volume.pieces(leaf)) {
      sum[index(piece.material)] += cell * std::abs(piece.weights.determinant());
    }
  });
  const double exact = 4.0 / 3 * M_PI * std::pow(kRadius, 3);
  EXPECT_NEAR(sum[0] + sum[1], 1000, 1e-9);
  EXPECT_NEAR(sum[0], exact, 0.2 * 4 * M_PI * kRadius * kRadius + 0.02 * exact);
}

TEST(MaterialVolume, InterfacesAndFieldsAreContinuousAcrossFaces) {
  MaterialVolume volume(ball_model());
  volume.refine({{0.4}, {10.0}});
  std::mt19937 random(8);
  int compared = 0;
  volume.mesh().for_each_leaf([&](CellId leaf) {
    const auto neighbours = volume.mesh().neighbours(leaf);
    const CellId other = neighbours[random() % 4];
    if (other == kNoCell) return;
    const Mask both = volume.materials_in(leaf) & volume.materials_in(other);
    const TetraCorners here = volume.corners(leaf);
    const int k = static_cast<int>(std::ranges::find(neighbours, other) - neighbours.begin());
    const Vector3d p = (here[(k + 1) % 4] + here[(k + 2) % 4] + here[(k + 3) % 4]) / 3;
    const auto a = Barycentric(here).weights(p), b = Barycentric(volume.corners(other)).weights(p);
    EXPECT_NEAR(a.dot(volume.distances(leaf, kBall)), b.dot(volume.distances(other, kBall)), 1e-9);
    for (const MaterialId m : {kIn, kOut}) {
      if ((both >> index(m) & 1) == 0) continue;
      EXPECT_NEAR(a.dot(volume.values(leaf, kDensity, m)), b.dot(volume.values(other, kDensity, m)),
                  1e-9);
      ++compared;
    }
  });
  EXPECT_GT(compared, 300);
}

TEST(MaterialVolume, GhostValuesAreTheFarSideAtTheNearestPlaceOfTheInterface) {
  MaterialVolume volume(ball_model());
  volume.refine({{0.4}, {kAnything}});
  const InterfaceSurface& surface = *volume.model().interfaces[0];
  int ghosts = 0;
  volume.mesh().for_each_leaf([&](CellId leaf) {
    if (volume.interfaces_in(leaf) == 0) return;
    for (const NodeId node : volume.mesh().corners(leaf)) {
      const Vector3d p = volume.mesh().position(node);
      const MaterialId own = volume.material(node), far = own == kIn ? kOut : kIn;
      const Vector3d there = surface.nearest(p).point;
      const Field& field = *volume.model().fields[0].field;
      EXPECT_DOUBLE_EQ(volume.value(node, kDensity, own), field.value(p, own));
      EXPECT_DOUBLE_EQ(volume.value(node, kDensity, far), field.value(there, far));
      ++ghosts;
    }
  });
  EXPECT_GT(ghosts, 100);
}

// where both sides are constant, explicit interfaces need no cells beyond those of the interface
TEST(MaterialVolume, AJumpBetweenConstantsCostsNoCells) {
  VolumeModel model = ball_model();
  const std::vector<double> ends = {0, 10};
  model.fields[0].field = std::make_shared<GridField>(
      std::array{ends, ends, ends},
      std::vector<std::vector<double>>{std::vector<double>(8, 7.8), std::vector<double>(8, 1.2)});
  MaterialVolume volume(model);
  volume.refine({{0.4}, {kAnything}});
  const std::size_t cells = volume.mesh().leaf_count();
  EXPECT_TRUE(volume.refine({{0.4}, {1e-6}}));
  EXPECT_EQ(volume.mesh().leaf_count(), cells);
}

TEST(MaterialVolume, ASheetBetweenTheVerticesIsNotLost) {
  VolumeModel model{kBox, {}, {{"sheet", {{InterfaceId{0}, true}}}, {"rest", {}}}, {}};
  SurfaceMesh sheet = testing::cube(2, 8);
  for (Vector3d& p : sheet.points) p.z() = p.z() > 5 ? 4.4 : 4.3;  // 0.1 thick in a box of 10
  model.interfaces = {std::make_shared<InterfaceSurface>("sheet", sheet, SideRule::kNormals, kBox)};
  MaterialVolume volume(model);
  EXPECT_TRUE(volume.refine({{0.5}, {}}));
  expect_interface_within(volume, InterfaceId{0}, 0.5, 400);
}

TEST(MaterialVolume, StopsAtTheBudgetWithTheWorstCellsSplit) {
  MaterialVolume volume(ball_model());
  EXPECT_FALSE(volume.refine({{0.01}, {kAnything}}, 1000));
  EXPECT_GE(volume.mesh().leaf_count(), 1000);
  EXPECT_LT(volume.mesh().leaf_count(), 1100);
}

TEST(MaterialVolume, CoarseningKeepsTheLargerTolerancesWithFewerCells) {
  MaterialVolume fine(ball_model()), direct(ball_model());
  fine.refine({{0.2}, {4.0}});
  const std::size_t before = fine.mesh().leaf_count();
  fine.coarsen({{0.6}, {10.0}});
  EXPECT_LT(fine.mesh().leaf_count(), before / 2);
  expect_interface_within(fine, kBall, 0.6, 200);
  expect_fields_within(fine, 10.0, 5000);
  direct.refine({{0.6}, {10.0}});
  EXPECT_LT(static_cast<double>(fine.mesh().leaf_count()),
            1.3 * static_cast<double>(direct.mesh().leaf_count()));
}

TEST(MaterialVolume, PublishedErrorMissesWhatPassesBetweenVertices) {
  VolumeModel model = ball_model();
  model.interfaces = {std::make_shared<InterfaceSurface>("cube", testing::cube(2.2, 7.7),
                                                         SideRule::kNormals, kBox)};
  const auto cells = [&](InterfaceErrorRule rule) {
    MaterialVolume volume(model, {.interface_error = rule});
    volume.refine({{0.2}, {kAnything}});
    return volume.mesh().leaf_count();
  };
  // eight vertices are all that it sees of a cube
  EXPECT_LT(cells(InterfaceErrorRule::kVertices), cells(InterfaceErrorRule::kStrict) / 2);
}

TEST(MaterialVolume, RefusesTolerancesThatDoNotFit) {
  MaterialVolume volume(ball_model());
  EXPECT_THROW(volume.refine({{}, {1.0}}), ConfigError);
  EXPECT_THROW(volume.refine({{0.0}, {1.0}}), ConfigError);
}

TEST(MaterialVolume, RefusesMaterialsThatLeaveSpaceEmpty) {
  VolumeModel model = ball_model();
  model.materials.pop_back();
  EXPECT_THROW(MaterialVolume{model}, ConfigError);
}

}  // namespace
}  // namespace terrane::hierarchy::volume

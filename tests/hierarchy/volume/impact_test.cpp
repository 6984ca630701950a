// The stand-in for the paper's simulation: its bounds held to 100,000 random places.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/hierarchy/volume/impact_model.h"
#include "tests/hierarchy/volume/measured_bounds.h"

namespace terrane::hierarchy::volume {
namespace {

using Eigen::Vector3d;
using testing::ImpactModel;

constexpr double kInterfaceTolerance = 0.15, kDensityTolerance = 3;
constexpr FieldId kDensity{0};
constexpr int kPlaces = 100'000;

const MaterialVolume& refined() {
  static const MaterialVolume volume = [] {
    MaterialVolume made(ImpactModel{}.model(DeviationRule::kEverywhere));
    EXPECT_TRUE(made.refine({{kInterfaceTolerance, kInterfaceTolerance}, {kDensityTolerance}}));
    return made;
  }();
  return volume;
}

class Impact : public ::testing::Test {
 protected:
  void SetUp() override {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "refining takes 18 s without sanitizers, minutes with them: "
                    "project.volume_bounds runs it on the release build";
#endif
  }
};

TEST_F(Impact, NoPlaceOfAnInterfaceIsFartherFromItsApproximationThanStated) {
  const InterfaceSurface& projectile = *refined().model().interfaces[0];
  for (const InterfaceId interface :
       {ImpactModel::kProjectileSurface, ImpactModel::kBlockSurface}) {
    const double stated = testing::stated_error(refined(), interface);
    EXPECT_LE(stated, kInterfaceTolerance);
    const testing::PieceGrid pieces(refined(), interface, 2 * kInterfaceTolerance);
    double largest = 0;
    // the top of the block inside the projectile parts nothing
    const auto is_hidden = [&](const Vector3d& p) {
      return interface == ImpactModel::kBlockSurface &&
             projectile.signed_distance(p, DistanceRule::kExact) < 0;
    };
    for (const Vector3d& p : testing::places_on(refined(), interface, kPlaces / 2, is_hidden)) {
      largest = std::max(largest, pieces.distance(p, largest));
    }
    EXPECT_LE(largest, stated + 1e-9) << refined().model().interfaces[index(interface)]->name();
    EXPECT_GT(largest, 0.2 * stated) << "the places find nothing";
  }
}

TEST_F(Impact, NoFieldErrorAt100000PlacesIsBeyondThatOfItsCell) {
  std::mt19937 random(12);
  const Field& density = *refined().model().fields[0].field;
  for (int i = 0; i < kPlaces; ++i) {
    const Vector3d p = testing::random_point(refined().mesh().box(), random);
    const auto [leaf, weights] = refined().mesh().locate(p);
    const MaterialId material = refined().true_material(p);
    const double value = weights.dot(refined().values(leaf, kDensity, material));
    const double error = std::abs(value - density.value(p, material));
    ASSERT_LE(error, refined().field_error(leaf, kDensity) + 1e-9) << p.transpose();
    ASSERT_LE(error, kDensityTolerance + 1e-9) << p.transpose();
  }
}

TEST_F(Impact, ErrorsAreNestedOnEveryPathAndBoundTheDistanceToTheDataAtEveryLevel) {
  const Field& density = *refined().model().fields[0].field;
  testing::expect_nested_errors(
      refined(), [&](const Vector3d& p, MaterialId material) { return density.value(p, material); },
      kPlaces / 5);
}

}  // namespace
}  // namespace terrane::hierarchy::volume

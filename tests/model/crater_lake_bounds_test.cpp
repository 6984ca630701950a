// Crater Lake at 20 m: the bounds of the approximation held to 100,000 random places.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include "core/progress.h"
#include "model/build_model.h"
#include "tests/hierarchy/volume/measured_bounds.h"

namespace terrane::model {
namespace {

using namespace hierarchy::volume;
using Eigen::Vector3d;
namespace measured = hierarchy::volume::testing;

constexpr double kTolerance = 20, kDensityTolerance = 2;  // metres; kg/m3
constexpr InterfaceId kGround{0}, kLake{1};
constexpr MaterialId kRock{0}, kWater{1};
constexpr FieldId kDensity{0};
constexpr int kPlaces = 100'000;

std::filesystem::path data() { return std::filesystem::path(TERRANE_TEST_DATA) / "crater_lake"; }

/// The formulas of config/volume/crater_lake.toml.
double density(const Vector3d& p, MaterialId material) {
  return material == kRock ? 2650 : 1000 + 0.0046 * (1882 - p.z());
}

MaterialVolume refine_crater_lake() {
  ModelSettings settings = read_model_file(std::filesystem::path(TERRANE_SOURCE_DIR) / "config" /
                                           "volume" / "crater_lake.toml");
  for (SurfaceSettings& surface : settings.surfaces) {
    for (std::string& dem : surface.dem) dem = data() / dem;
    if (!surface.inside.empty()) surface.inside = data() / surface.inside;
  }
  NoProgress progress;
  Model model = build_model(settings, progress);
  MaterialVolume volume(std::move(model.volume));
  EXPECT_TRUE(volume.refine({{kTolerance, kTolerance}, {kDensityTolerance}}));
  return volume;
}

/// Made once, for all tests.
const MaterialVolume& lake() {
  static const MaterialVolume volume = refine_crater_lake();
  return volume;
}

class CraterLake : public ::testing::Test {
 protected:
  void SetUp() override {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "refining takes 19 s without sanitizers, minutes with them: "
                    "project.crater_lake_bounds runs it on the release build";
#endif
    if (!std::filesystem::exists(data())) GTEST_SKIP() << data() << " is not there";
  }
};

/// The lake's bottom and sides under the ground part nothing.
bool is_hidden(InterfaceId interface, const Vector3d& p) {
  return interface == kLake &&
         lake().model().interfaces[index(kGround)]->signed_distance(p, DistanceRule::kExact) < 0;
}

TEST_F(CraterLake, NoPlaceOfAnInterfaceIsFartherFromItsApproximationThanItsCellStates) {
  for (const InterfaceId interface : {kGround, kLake}) {
    const double stated = measured::stated_error(lake(), interface);
    EXPECT_LE(stated, kTolerance);
    const measured::PieceGrid pieces(lake(), interface, 2 * kTolerance);
    double largest = 0;
    int beyond = 0;
    const auto places = measured::places_on(
        lake(), interface, kPlaces / 2, [&](const Vector3d& p) { return is_hidden(interface, p); });
    for (const Vector3d& p : places) {
      const CellId leaf = lake().mesh().locate(p).leaf;
      const double distance = pieces.distance(p, 0);
      largest = std::max(largest, distance);
      if (distance > lake().interface_error(leaf, interface) + 1e-6) ++beyond;
    }
    const std::string& name = lake().model().interfaces[index(interface)]->name();
    EXPECT_EQ(beyond, 0) << name;
    EXPECT_LE(largest, stated + 1e-6) << name;
    EXPECT_GT(largest, 0.2 * stated) << "the places find nothing";
    RecordProperty(name + "_stated_m", std::to_string(stated));
    RecordProperty(name + "_largest_m", std::to_string(largest));
  }
}

TEST_F(CraterLake, NoPlaceOfAnApproximationIsFartherFromItsInterfaceThanItsCellStates) {
  std::mt19937 random(14);
  int places = 0, beyond = 0;
  for (const InterfaceId interface : {kGround, kLake}) {
    const InterfaceSurface& surface = *lake().model().interfaces[index(interface)];
    lake().mesh().for_each_leaf([&](CellId leaf) {
      const ZeroSet piece = lake().approximation(leaf, interface);
      if (piece.size < 3) return;
      const int k = std::uniform_int_distribution<int>(2, piece.size - 1)(random);
      const Vector3d p =
          measured::random_point({piece.points[0], piece.points[k - 1], piece.points[k]}, random);
      const double distance = std::sqrt(surface.nearest(p).squared_distance);
      ++places;
      if (distance > lake().interface_error(leaf, interface) + 1e-6) ++beyond;
    });
  }
  EXPECT_EQ(beyond, 0);
  EXPECT_GE(places, kPlaces);
  RecordProperty("places", places);
}

TEST_F(CraterLake, NoFieldErrorAt100000PlacesIsBeyondThatOfItsCell) {
  std::mt19937 random(12);
  std::array<int, 2> places = {0, 0};
  std::array<double, 2> largest = {0, 0};
  while (std::min(places[0], places[1]) < kPlaces / 2) {
    const Vector3d p = measured::random_point(lake().mesh().box(), random);
    const MaterialId material = lake().true_material(p);
    if (material != kRock && material != kWater) continue;  // air has no field
    if (places[index(material)] == kPlaces / 2) continue;
    ++places[index(material)];
    const auto [leaf, weights] = lake().mesh().locate(p);
    const double value = weights.dot(lake().values(leaf, kDensity, material));
    const double error = std::abs(value - density(p, material));
    largest[index(material)] = std::max(largest[index(material)], error);
    ASSERT_LE(error, lake().field_error(leaf, kDensity) + 1e-6) << p.transpose();
    ASSERT_LE(error, kDensityTolerance + 1e-6) << p.transpose();
  }
  EXPECT_GT(largest[1], 0.01 * kDensityTolerance) << "the places find nothing";
  RecordProperty("water_largest", std::to_string(largest[1]));
}

TEST_F(CraterLake, ErrorsAreNestedOnEveryPathAndBoundTheDistanceToTheDataAtEveryLevel) {
  measured::expect_nested_errors(lake(), density, kPlaces / 5);
}

}  // namespace
}  // namespace terrane::model

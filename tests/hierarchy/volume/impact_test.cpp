// The stand-in for the paper's simulation: its bounds held to 100,000 random places, by code that
// knows no cells where it looks for the approximation.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "hierarchy/volume/nested_errors.h"
#include "tests/hierarchy/volume/impact_model.h"

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

/// Pieces of an approximation, found by the cubes of a grid that they reach into.
class PieceGrid {
 public:
  PieceGrid(const MaterialVolume& volume, InterfaceId interface) {
    volume.mesh().for_each_leaf([&](CellId leaf) {
      const ZeroSet piece = volume.approximation(leaf, interface);
      if (piece.is_empty()) return;
      Vector3d low = piece.points[0], high = low;
      for (int k = 1; k < piece.size; ++k) {
        low = low.cwiseMin(piece.points[k]);
        high = high.cwiseMax(piece.points[k]);
      }
      const auto begin = cube(low), end = cube(high);
      for (int x = begin[0]; x <= end[0]; ++x) {
        for (int y = begin[1]; y <= end[1]; ++y) {
          for (int z = begin[2]; z <= end[2]; ++z) cubes_[{x, y, z}].push_back(piece);
        }
      }
    });
  }

  /// Distance to the nearest piece, as far as that is less than a cube's side; a piece as near as
  /// \p enough ends the search.
  double distance(const Vector3d& p, double enough) const {
    double nearest = kSide;
    const auto at = cube(p);
    for (const int x : {0, -1, 1}) {
      for (const int y : {0, -1, 1}) {
        for (const int z : {0, -1, 1}) {
          const auto found = cubes_.find({at[0] + x, at[1] + y, at[2] + z});
          if (found == cubes_.end()) continue;
          for (const ZeroSet& piece : found->second) {
            nearest = std::min(nearest, piece.distance(p));
            if (nearest <= enough) return nearest;
          }
        }
      }
    }
    return nearest;
  }

 private:
  static constexpr double kSide = 2 * kInterfaceTolerance;
  static std::array<int, 3> cube(const Vector3d& p) {
    const auto of = [](double x) { return static_cast<int>(std::floor(x / kSide)); };
    return {of(p.x()), of(p.y()), of(p.z())};
  }

  std::map<std::array<int, 3>, std::vector<ZeroSet>> cubes_;
};

/// Places on an interface, evenly over its area, where it parts two materials in the box.
std::vector<Vector3d> places_on(const MaterialVolume& volume, InterfaceId interface, int count) {
  const InterfaceSurface& surface = *volume.model().interfaces[index(interface)];
  const auto triangles = static_cast<std::uint32_t>(surface.mesh().triangles.size());
  std::vector<double> area;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const auto [a, b, c] = surface.corners(t);
    area.push_back((b - a).cross(c - a).norm());
  }
  std::mt19937 random(11);
  std::discrete_distribution<std::uint32_t> any(area.begin(), area.end());
  const InterfaceSurface& projectile = *volume.model().interfaces[0];
  const Box& box = volume.mesh().box();
  std::vector<Vector3d> places;
  while (static_cast<int>(places.size()) < count) {
    const Vector3d p = testing::random_point(surface.corners(any(random)), random);
    const bool is_inside =
        (p.array() >= box.low.array()).all() && (p.array() <= box.high.array()).all();
    // the top of the block inside the projectile parts nothing
    const bool is_hidden = interface == ImpactModel::kBlockSurface &&
                           projectile.signed_distance(p, DistanceRule::kExact) < 0;
    if (is_inside && !is_hidden) places.push_back(p);
  }
  return places;
}

TEST_F(Impact, NoPlaceOfAnInterfaceIsFartherFromItsApproximationThanStated) {
  for (const InterfaceId interface :
       {ImpactModel::kProjectileSurface, ImpactModel::kBlockSurface}) {
    double stated = 0;
    refined().mesh().for_each_leaf([&](CellId leaf) {
      stated = std::max(stated, refined().interface_error(leaf, interface));
    });
    EXPECT_LE(stated, kInterfaceTolerance);
    const PieceGrid pieces(refined(), interface);
    double largest = 0;
    for (const Vector3d& p : places_on(refined(), interface, kPlaces / 2)) {
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

/// Corners of any cell of the tree: those of its children less the vertex that split it.
class TreeCorners {
 public:
  explicit TreeCorners(const TetraMesh& mesh) : mesh_(mesh) {}

  const std::array<NodeId, 4>& of(CellId cell) {
    if (mesh_.is_leaf(cell)) return mesh_.corners(cell);
    const auto at = known_.find(index(cell));
    if (at != known_.end()) return at->second;
    std::vector<NodeId> all;
    for (const CellId child : mesh_.children(cell)) {
      const std::array<NodeId, 4> corners = of(child);
      all.insert(all.end(), corners.begin(), corners.end());
    }
    std::ranges::sort(all);
    const auto again = std::ranges::unique(all);
    all.erase(again.begin(), again.end());
    std::erase(all, mesh_.middle(cell));
    EXPECT_EQ(all.size(), 4U);
    std::array<NodeId, 4> corners;
    std::ranges::copy(all, corners.begin());
    return known_.emplace(index(cell), corners).first->second;
  }

 private:
  const TetraMesh& mesh_;
  std::unordered_map<std::size_t, std::array<NodeId, 4>> known_;
};

TEST_F(Impact, ErrorsAreNestedOnEveryPathAndBoundTheDistanceToTheDataAtEveryLevel) {
  const MaterialVolume& volume = refined();
  const NestedErrors nested(volume);
  TreeCorners tree(volume.mesh());
  const Field& density = *volume.model().fields[0].field;
  std::mt19937 random(13);
  long looked_at = 0;
  for (int i = 0; i < kPlaces / 5; ++i) {
    const Vector3d p = testing::random_point(volume.mesh().box(), random);
    const MaterialId material = volume.true_material(p);
    CellId cell = volume.mesh().locate(p).leaf;
    double below = 0, below_interface = 0;
    for (;;) {
      const double error = nested.field_error(cell, kDensity);
      const double own = nested.interface_error(cell, ImpactModel::kBlockSurface);
      ASSERT_GE(error, below);
      ASSERT_GE(own, below_interface);
      below = error;
      below_interface = own;
      TetraCorners places;
      Eigen::Vector4d values;
      for (int k = 0; k < 4; ++k) {
        const NodeId node = tree.of(cell)[static_cast<std::size_t>(k)];
        places[static_cast<std::size_t>(k)] = volume.mesh().position(node);
        values[k] = volume.value(node, kDensity, material);
      }
      const double value = Barycentric(places).weights(p).dot(values);
      ASSERT_LE(std::abs(value - density.value(p, material)), error + 1e-6)
          << p.transpose() << " material " << index(material);
      ++looked_at;
      if (volume.mesh().is_root(cell)) break;
      cell = volume.mesh().parent(cell);
    }
  }
  EXPECT_GT(looked_at, 10 * kPlaces / 5);
}

}  // namespace
}  // namespace terrane::hierarchy::volume

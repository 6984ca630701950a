#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <unordered_map>
#include <vector>

#include "hierarchy/volume/material_volume.h"
#include "hierarchy/volume/nested_errors.h"
#include "tests/hierarchy/volume/test_surfaces.h"

// What a volume states, measured at random places by code that knows no cells where it looks for
// the approximation.
namespace terrane::hierarchy::volume::testing {

/// Pieces of an approximation, found by the cubes of a grid that they reach into.
class PieceGrid {
 public:
  /// \param side  of a cube: distances are told as far as that.
  PieceGrid(const MaterialVolume& volume, InterfaceId interface, double side) : side_(side) {
    volume.mesh().for_each_leaf([&](CellId leaf) {
      const ZeroSet piece = volume.approximation(leaf, interface);
      if (piece.is_empty()) return;
      Eigen::Vector3d low = piece.points[0], high = low;
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
  double distance(const Eigen::Vector3d& p, double enough) const {
    double nearest = side_;
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
  std::array<int, 3> cube(const Eigen::Vector3d& p) const {
    const auto of = [&](double x) { return static_cast<int>(std::floor(x / side_)); };
    return {of(p.x()), of(p.y()), of(p.z())};
  }

  double side_;
  std::map<std::array<int, 3>, std::vector<ZeroSet>> cubes_;
};

/// Places on an interface, evenly over its area, where they lie in the box and are not hidden.
template <class IsHidden>
std::vector<Eigen::Vector3d> places_on(const MaterialVolume& volume, InterfaceId interface,
                                       int count, const IsHidden& is_hidden) {
  const InterfaceSurface& surface = *volume.model().interfaces[index(interface)];
  const auto triangles = static_cast<std::uint32_t>(surface.mesh().triangles.size());
  std::vector<double> area;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const auto [a, b, c] = surface.corners(t);
    area.push_back((b - a).cross(c - a).norm());
  }
  std::mt19937 random(11);
  std::discrete_distribution<std::uint32_t> any(area.begin(), area.end());
  const Box& box = volume.mesh().box();
  std::vector<Eigen::Vector3d> places;
  while (static_cast<int>(places.size()) < count) {
    const Eigen::Vector3d p = random_point(surface.corners(any(random)), random);
    const bool is_inside =
        (p.array() >= box.low.array()).all() && (p.array() <= box.high.array()).all();
    if (is_inside && !is_hidden(p)) places.push_back(p);
  }
  return places;
}

/// The largest error that is stated for an interface.
inline double stated_error(const MaterialVolume& volume, InterfaceId interface) {
  double stated = 0;
  volume.mesh().for_each_leaf(
      [&](CellId leaf) { stated = std::max(stated, volume.interface_error(leaf, interface)); });
  return stated;
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

/// Walks from leaves to the roots: errors of the first field and of all interfaces never fall, and
/// each cell's own function is within its nested error of the truth at the place that the walk
/// began at, if that is not in an empty material.
/// \param truth  of the field, at a place in a material.
template <class Truth>
void expect_nested_errors(const MaterialVolume& volume, const Truth& truth, int paths) {
  constexpr FieldId kField{0};
  const NestedErrors nested(volume);
  TreeCorners tree(volume.mesh());
  std::mt19937 random(13);
  long looked_at = 0;
  for (int i = 0; i < paths; ++i) {
    const Eigen::Vector3d p = random_point(volume.mesh().box(), random);
    const MaterialId material = volume.true_material(p);
    const bool has_field = !volume.model().materials[index(material)].is_empty;
    double below = 0;
    std::vector<double> below_interface(volume.interface_count(), 0.0);
    for (CellId cell = volume.mesh().locate(p).leaf;; cell = volume.mesh().parent(cell)) {
      const double error = nested.field_error(cell, kField);
      ASSERT_GE(error, below);
      below = error;
      for (std::uint8_t k = 0; k < volume.interface_count(); ++k) {
        const double own = nested.interface_error(cell, InterfaceId{k});
        ASSERT_GE(own, below_interface[k]);
        below_interface[k] = own;
      }
      TetraCorners places;
      Eigen::Vector4d values;
      for (int k = 0; k < 4; ++k) {
        const NodeId node = tree.of(cell)[static_cast<std::size_t>(k)];
        places[static_cast<std::size_t>(k)] = volume.mesh().position(node);
        values[k] = volume.value(node, kField, material);
      }
      const double value = Barycentric(places).weights(p).dot(values);
      if (has_field) {
        ASSERT_LE(std::abs(value - truth(p, material)), error + 1e-6)
            << p.transpose() << " material " << index(material);
      }
      ++looked_at;
      if (volume.mesh().is_root(cell)) break;
    }
  }
  EXPECT_GT(looked_at, 10 * paths);
}

}  // namespace terrane::hierarchy::volume::testing

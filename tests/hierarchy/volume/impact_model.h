#pragma once

#include <cmath>
#include <memory>

#include "hierarchy/volume/grid_field.h"
#include "hierarchy/volume/material_volume.h"
#include "tests/hierarchy/volume/test_surfaces.h"

namespace terrane::hierarchy::volume::testing {

/// A stand-in for the simulation of Gregorski et al. 2003, section 8, which is not to be had: a
/// projectile that has struck the top of a block, a quarter of it by symmetry, on their domain and
/// grid. Shapes and densities are made up; the sizes of the three interfaces are close to theirs.
struct ImpactModel {
  static constexpr MaterialId kProjectile{0}, kBlock{1}, kEmpty{2};
  static constexpr std::uint32_t kTopCells = 87;
  static constexpr InterfaceId kProjectileSurface{0}, kBlockSurface{1};

  Box box{Eigen::Vector3d(0, 0, -16), Eigen::Vector3d(12, 12, 4.8)};

  /// Top of the block: a crater around the axis x = y = 0 with a raised rim.
  static double block_top(double x, double y) {
    const double r = std::hypot(x, y);
    return -2.6 * std::exp(-std::pow(r / 2.1, 4)) + 0.9 * std::exp(-std::pow((r - 3.0) / 0.7, 2));
  }

  /// The block is open where it leaves the box: at x < 0, y < 0 and z < -16.
  static SurfaceMesh block() {
    constexpr std::uint32_t kCells = kTopCells, kRows = 18;
    constexpr double kLow = -1, kHigh = 9.7, kBottom = -17;
    SurfaceMesh mesh = heights(kLow, kHigh, kCells, block_top);
    const std::uint32_t side = kCells + 1;
    // walls hang from the two sides of the top that lie in the box: x = high, then y = high
    for (const bool is_x : {true, false}) {
      std::vector<std::uint32_t> above;
      for (std::uint32_t i = 0; i < side; ++i) {
        above.push_back(is_x ? i * side + kCells : kCells * side + (kCells - i));
      }
      for (std::uint32_t row = 1; row <= kRows; ++row) {
        std::vector<std::uint32_t> below;
        for (std::uint32_t i = 0; i < side; ++i) {
          const Eigen::Vector3d top =
              mesh.points[is_x ? i * side + kCells : kCells * side + (kCells - i)];
          const bool is_corner_again = !is_x && i == 0;
          if (is_corner_again) {
            below.push_back(corner_column_(row));
            continue;
          }
          const double z = top.z() + (kBottom - top.z()) * row / kRows;
          below.push_back(static_cast<std::uint32_t>(mesh.points.size()));
          mesh.points.emplace_back(top.x(), top.y(), z);
        }
        for (std::uint32_t i = 0; i + 1 < side; ++i) {
          mesh.triangles.push_back({above[i], below[i], below[i + 1]});
          mesh.triangles.push_back({above[i], below[i + 1], above[i + 1]});
        }
        above = below;
      }
    }
    return mesh;
  }

  /// An ellipsoid around the axis, sunk into the crater; 156 of its triangles lie in the box.
  static SurfaceMesh projectile() {
    constexpr int kSectors = 24, kRings = 14;
    const Eigen::Vector3d centre(0, 0, -1.0), half(1.5, 1.5, 2.0);
    SurfaceMesh mesh;
    const auto at = [&](int sector, int ring) -> std::uint32_t {
      if (ring == 0) return 0;
      if (ring == kRings) return 1;
      return static_cast<std::uint32_t>(2 + (ring - 1) * kSectors + sector % kSectors);
    };
    mesh.points = {centre - Eigen::Vector3d(0, 0, half.z()),
                   centre + Eigen::Vector3d(0, 0, half.z())};
    for (int ring = 1; ring < kRings; ++ring) {
      for (int sector = 0; sector < kSectors; ++sector) {
        const double u = M_PI * ring / kRings, v = 2 * M_PI * sector / kSectors;
        const Eigen::Vector3d on(std::sin(u) * std::cos(v), std::sin(u) * std::sin(v),
                                 -std::cos(u));
        mesh.points.push_back(centre + half.cwiseProduct(on));
      }
    }
    for (int ring = 0; ring < kRings; ++ring) {
      for (int s = 0; s < kSectors; ++s) {
        const auto a = at(s, ring), b = at(s + 1, ring), c = at(s, ring + 1),
                   d = at(s + 1, ring + 1);
        if (ring > 0) mesh.triangles.push_back({a, b, d});
        if (ring + 1 < kRings) mesh.triangles.push_back({a, d, c});
      }
    }
    return mesh;
  }

  /// A pressure wave runs through the block; the projectile is denser at its tip.
  static double density(const Eigen::Vector3d& p, MaterialId material) {
    const double r = (p - Eigen::Vector3d(0, 0, -1)).norm();
    if (material == kBlock) return 80 + 40 * std::exp(-std::pow((r - 6.0) / 1.6, 2));
    if (material == kProjectile) return 120 - 8 * (p.z() + 1.0);
    return 0;
  }

  VolumeModel model(DeviationRule rule) const {
    VolumeModel model;
    model.box = box;
    model.interfaces = {
        std::make_shared<InterfaceSurface>("projectile", projectile(), SideRule::kNormals, box),
        std::make_shared<InterfaceSurface>("block", block(), SideRule::kNormals, box)};
    model.materials = {{"projectile", {{kProjectileSurface, true}}, false},
                       {"block", {{kBlockSurface, true}}, false},
                       {"empty", {}, true}};
    model.fields = {{"density", "", sampled({kProjectile, kBlock, kEmpty}, density, rule)}};
    return model;
  }

  /// One material, and the density of what is really there at each post of the grid.
  VolumeModel model_without_interfaces(DeviationRule rule) const {
    const VolumeModel with = model(rule);
    const auto below = [&](InterfaceId id, const Eigen::Vector3d& p) {
      return with.interfaces[index(id)]->signed_distance(p, DistanceRule::kExact) < 0;
    };
    const auto whole = [&](const Eigen::Vector3d& p, MaterialId) {
      if (below(kProjectileSurface, p)) return density(p, kProjectile);
      return density(p, below(kBlockSurface, p) ? kBlock : kEmpty);
    };
    return {
        box, {}, {{"all", {}, false}}, {{"density", "", sampled({MaterialId{0}}, whole, rule)}}};
  }

  static std::array<std::vector<double>, 3> posts() {
    std::array<std::vector<double>, 3> axes;
    for (int i = 0; i <= 32; ++i) axes[0].push_back(12.0 * i / 32);
    axes[1] = axes[0];
    for (int i = 0; i <= 52; ++i) axes[2].push_back(-16 + 20.8 * i / 52);
    return axes;
  }

 private:
  // the two walls meet at x = y = high: the second takes the first one's last column
  static std::uint32_t corner_column_(std::uint32_t row) {
    constexpr std::uint32_t kSide = kTopCells + 1;
    return kSide * kSide + row * kSide - 1;
  }

  template <class F>
  static std::shared_ptr<const Field> sampled(const std::vector<MaterialId>& materials, const F& f,
                                              DeviationRule rule) {
    const auto axes = posts();
    std::vector<std::vector<double>> values(materials.size());
    for (std::size_t m = 0; m < materials.size(); ++m) {
      for (const double z : axes[2]) {
        for (const double y : axes[1]) {
          for (const double x : axes[0]) {
            values[m].push_back(f(Eigen::Vector3d(x, y, z), materials[m]));
          }
        }
      }
    }
    return std::make_shared<GridField>(axes, std::move(values), rule);
  }
};

}  // namespace terrane::hierarchy::volume::testing

#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <random>

#include "hierarchy/volume/interface_surface.h"

namespace terrane::hierarchy::volume::testing {

/// The cube [low, high]^3: eight corners, twelve triangles, normals outward.
inline SurfaceMesh cube(double low, double high) {
  SurfaceMesh mesh;
  for (int k = 0; k < 8; ++k) {
    mesh.points.emplace_back((k & 1) != 0 ? high : low, (k & 2) != 0 ? high : low,
                             (k & 4) != 0 ? high : low);
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// A sphere: an octahedron whose triangles are quartered; 8 * 4^times triangles, all corners on it.
inline SurfaceMesh sphere(const Eigen::Vector3d& centre, double radius, int times) {
  SurfaceMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) mesh.points.push_back(sign * Eigen::Vector3d::Unit(axis));
  }
  for (std::uint32_t k = 0; k < 8; ++k) {
    const std::uint32_t x = k & 1, y = 2 + (k >> 1 & 1), z = 4 + (k >> 2);
    const bool is_mirrored = ((k & 1) + (k >> 1 & 1) + (k >> 2)) % 2 == 1;
    if (is_mirrored) {
      mesh.triangles.push_back({x, z, y});
    } else {
      mesh.triangles.push_back({x, y, z});
    }
  }
  for (int round = 0; round < times; ++round) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), mesh.points.size());
      if (is_new) mesh.points.push_back((mesh.points[a] + mesh.points[b]).normalized());
      return at->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const auto ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = finer;
  }
  for (auto& point : mesh.points) point = centre + radius * point;
  return mesh;
}

/// Heights over [low, high]^2 with `cells` cells along each side.
inline SurfaceMesh heights(double low, double high, std::uint32_t cells,
                           const std::function<double(double, double)>& height) {
  SurfaceMesh mesh;
  for (std::uint32_t j = 0; j <= cells; ++j) {
    for (std::uint32_t i = 0; i <= cells; ++i) {
      const double x = low + (high - low) * i / cells, y = low + (high - low) * j / cells;
      mesh.points.emplace_back(x, y, height(x, y));
    }
  }
  for (std::uint32_t j = 0; j < cells; ++j) {
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t a = j * (cells + 1) + i, b = a + 1, c = a + cells + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  }
  return mesh;
}

inline Eigen::Vector3d random_point(const Box& box, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const Eigen::Vector3d t(unit(random), unit(random), unit(random));
  return box.low + box.size().cwiseProduct(t);
}

/// A point spread evenly over a triangle.
inline Eigen::Vector3d random_point(const std::array<Eigen::Vector3d, 3>& triangle,
                                    std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double s = std::sqrt(unit(random)), t = unit(random);
  return (1 - s) * triangle[0] + s * (1 - t) * triangle[1] + s * t * triangle[2];
}

}  // namespace terrane::hierarchy::volume::testing

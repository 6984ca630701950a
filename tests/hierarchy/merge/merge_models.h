#pragma once

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <random>
#include <set>
#include <utility>

#include "hierarchy/merge/merge_front.h"
#include "hierarchy/merge/merge_tree.h"
#include "tests/hierarchy/levels/test_surfaces.h"

namespace terrane::hierarchy::testing {

/// A unit sphere of 8 * 4^halvings triangles: an octahedron, halved.
inline SurfaceMesh sphere(int halvings) {
  SurfaceMesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      Eigen::Vector3d p = Eigen::Vector3d::Zero();
      p[axis] = sign;
      mesh.points.push_back(p);
    }
  }
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int i = 0; i < halvings; ++i) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.points.size()));
      if (is_new) mesh.points.push_back((mesh.points[a] + mesh.points[b]).normalized());
      return at->second;
    };
    std::vector<Corners> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const Corners& t :
           {Corners{a, ab, ca}, Corners{ab, b, bc}, Corners{ca, bc, c}, Corners{ab, bc, ca}}) {
        finer.push_back(t);
      }
    }
    mesh.triangles = finer;
  }
  return mesh;
}

/// Hills of several sizes over [-1, 1] x [-1, 1].
inline SurfaceMesh hills(std::uint32_t columns, std::uint32_t rows) {
  return sheet(columns, rows, [](double x, double y) {
    return 0.2 * std::sin(3 * x + 1) * std::cos(2 * y) + 0.05 * std::sin(11 * x * y + 2) +
           0.01 * std::sin(37 * x) * std::sin(41 * y + x);
  });
}

/// A torus with holes in it: open, and not a height field.
inline SurfaceMesh torn_torus(std::uint32_t m, std::uint32_t n) {
  SurfaceMesh mesh = torus(m, n);
  std::erase_if(mesh.triangles, [&](const Corners& c) {
    const Eigen::Vector3d& p = mesh.points[c[0]];
    return (p.x() > 0.9 && p.z() > 0.1) || (p.y() < -0.8 && std::abs(p.x()) < 0.2);
  });
  return mesh;
}

/// Red where x is above 0 and blue elsewhere, less a green spot of one vertex.
inline SurfaceMesh painted(SurfaceMesh mesh) {
  for (const Eigen::Vector3d& p : mesh.points) {
    mesh.colours.push_back(p.x() > 0 ? Colour{200, 0, 20} : Colour{0, 0, 220});
  }
  mesh.colours[mesh.points.size() / 2] = {0, 255, 0};
  return mesh;
}

inline std::vector<Corners> shown_triangles(const MergeTree& tree, const MergeFront& front) {
  std::vector<Corners> result;
  for (const std::uint32_t t : front.display().shown()) result.push_back(tree.triangles[t]);
  return result;
}

/// The triangles that show, by place: what a frame looks like, whatever led to it.
inline std::multiset<std::array<Place, 3>> shape_shown(const MergeTree& tree,
                                                       const MergeFront& front) {
  SurfaceMesh mesh;
  for (std::uint32_t v = 0; v < tree.points.size(); ++v) {
    mesh.points.push_back(tree.place(v).cast<double>());
  }
  mesh.triangles = shown_triangles(tree, front);
  return shape_of_mesh(mesh);
}

inline std::vector<Corners> full_mesh_triangles(const MergeTree& tree) {
  std::vector<Corners> result;
  const std::vector<bool> is_full = full_triangles(tree);
  for (std::size_t t = 0; t < is_full.size(); ++t) {
    if (is_full[t]) result.push_back(tree.triangles[t]);
  }
  return result;
}

/// Cameras near a model about the middle of [-1, 1]^3, in the frame of a tree.
class RandomViews {
 public:
  RandomViews(const MergeTree& tree, std::uint32_t seed)
      : middle_(-tree.lattice.origin()), random_(seed) {}

  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() % 100001) / 100000;
  }
  Eigen::Vector3d direction() {
    const double z = between(-1, 1), u = between(0, 6.28318);
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(u), r * std::sin(u), z};
  }
  Camera camera() {
    const Eigen::Vector3d eye = middle_ + between(0.3, 5) * direction();
    Camera camera = Camera::looking_at(eye, middle_ + between(0, 0.2) * direction(), direction());
    camera.vertical_fov_deg = between(20, 90);
    return camera;
  }
  /// Any criteria: half of them on.
  ViewCriteria criteria() {
    ViewCriteria criteria;
    criteria.measure = coin() ? ScreenMeasure::kError : ScreenMeasure::kSwitchDistance;
    criteria.tolerance_px =
        criteria.measure == ScreenMeasure::kError ? between(0.2, 20) : between(10, 200);
    criteria.frustum = coin();
    criteria.back_faces = coin();
    if (coin()) criteria.silhouette_px = criteria.tolerance_px / 4;
    if (coin()) criteria.highlight_px = between(10, 60);
    criteria.to_light = direction();
    return criteria;
  }
  bool coin() { return random_() % 2 == 0; }

 private:
  Eigen::Vector3d middle_;
  std::mt19937 random_;
};

}  // namespace terrane::hierarchy::testing

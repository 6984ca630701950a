#pragma once

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <vector>

#include "hierarchy/levels/level_sequence.h"
#include "hierarchy/levels/surface_mesh.h"

namespace terrane::hierarchy::testing {

/// OpenMesh refuses a face that would make its half-edge structure non-manifold.
struct Oracle {
  bool is_manifold = true;
  long euler = 0;
  long border_edges = 0;

  explicit Oracle(const std::vector<Corners>& triangles) {
    OpenMesh::TriMesh_ArrayKernelT<> mesh;
    std::map<std::uint32_t, OpenMesh::VertexHandle> handles;
    for (const Corners& corners : triangles) {
      std::vector<OpenMesh::VertexHandle> face;
      for (const std::uint32_t v : corners) {
        auto [at, is_new] = handles.try_emplace(v);
        if (is_new) at->second = mesh.add_vertex({0, 0, 0});
        face.push_back(at->second);
      }
      is_manifold = is_manifold && mesh.add_face(face).is_valid();
    }
    for (const auto edge : mesh.edges()) border_edges += mesh.is_boundary(edge);
    euler = static_cast<long>(mesh.n_vertices()) - static_cast<long>(mesh.n_edges()) +
            static_cast<long>(mesh.n_faces());
  }
};

/// Points on a grid of columns x rows samples, from x = y = -1 to 1, two triangles a cell.
template <class Height>
SurfaceMesh sheet(std::uint32_t columns, std::uint32_t rows, Height height) {
  SurfaceMesh mesh;
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const double x = 2.0 * i / (columns - 1) - 1, y = 2.0 * j / (rows - 1) - 1;
      mesh.points.push_back({x, y, height(x, y)});
    }
  }
  for (std::uint32_t j = 0; j + 1 < rows; ++j) {
    for (std::uint32_t i = 0; i + 1 < columns; ++i) {
      const std::uint32_t a = j * columns + i, b = a + 1, c = a + columns + 1, d = a + columns;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

inline SurfaceMesh saddle(std::uint32_t columns, std::uint32_t rows) {
  return sheet(columns, rows, [](double x, double y) { return x * x - y * y; });
}

/// A torus of 2 m n triangles, about the z axis, radii 1 and 0.4.
inline SurfaceMesh torus(std::uint32_t m, std::uint32_t n) {
  SurfaceMesh mesh;
  for (std::uint32_t i = 0; i < m; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const double u = 2 * std::numbers::pi * i / m, v = 2 * std::numbers::pi * j / n;
      const double r = 1 + 0.4 * std::cos(v);
      mesh.points.push_back({r * std::cos(u), r * std::sin(u), 0.4 * std::sin(v)});
    }
  }
  for (std::uint32_t i = 0; i < m; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t ni = (i + 1) % m, nj = (j + 1) % n;
      mesh.triangles.push_back({i * n + j, ni * n + j, ni * n + nj});
      mesh.triangles.push_back({i * n + j, ni * n + nj, i * n + nj});
    }
  }
  return mesh;
}

/// The surface of a slab of cubes, 2 * holes + 1 by 3, with holes through it: closed, of that
/// genus.
///
/// \param fine  squares along the side of a cube.
class Slab {
 public:
  Slab(int holes, int fine) : holes_(holes), fine_(fine) {
    for (int x = 0; x < 2 * holes + 1; ++x) {
      for (int y = 0; y < 3; ++y) {
        if (is_solid(x, y, 0)) add_cube(x, y);
      }
    }
  }
  SurfaceMesh mesh() const { return mesh_; }

 private:
  bool is_solid(int x, int y, int z) const {
    const bool is_inside = x >= 0 && x < 2 * holes_ + 1 && y >= 0 && y < 3 && z == 0;
    return is_inside && !(y == 1 && x % 2 == 1);
  }

  void add_cube(int x, int y) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        std::array<int, 3> next{x, y, 0};
        next[axis] += side == 1 ? 1 : -1;
        if (!is_solid(next[0], next[1], next[2])) add_face({x, y, 0}, axis, side);
      }
    }
  }

  void add_face(std::array<int, 3> cube, int axis, int side) {
    for (int i = 0; i < fine_; ++i) {
      for (int j = 0; j < fine_; ++j) {
        const auto corner = [&](int di, int dj) {
          std::array<int, 3> p{cube[0] * fine_, cube[1] * fine_, cube[2] * fine_};
          p[axis] += side * fine_;
          p[(axis + 1) % 3] += i + di;
          p[(axis + 2) % 3] += j + dj;
          return vertex(p);
        };
        const auto a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
        if (side == 1) {
          mesh_.triangles.push_back({a, b, c});
          mesh_.triangles.push_back({a, c, d});
        } else {
          mesh_.triangles.push_back({a, c, b});
          mesh_.triangles.push_back({a, d, c});
        }
      }
    }
  }

  std::uint32_t vertex(const std::array<int, 3>& p) {
    const auto [at, is_new] =
        number_.try_emplace(p, static_cast<std::uint32_t>(mesh_.points.size()));
    if (is_new) mesh_.points.push_back(Eigen::Vector3d(p[0], p[1], p[2]));
    return at->second;
  }

  int holes_, fine_;
  SurfaceMesh mesh_;
  std::map<std::array<int, 3>, std::uint32_t> number_;
};

/// Moves every vertex by up to a distance on each axis.
inline void jitter(SurfaceMesh& mesh, double by, std::mt19937& random) {
  const auto offset = [&] { return by * (static_cast<double>(random() % 2001) / 1000 - 1); };
  for (Eigen::Vector3d& p : mesh.points) {
    const double x = offset(), y = offset(), z = offset();
    p += Eigen::Vector3d(x, y, z);
  }
}

/// Takes out triangles at random places, one by one: boundaries, and vertices where they touch.
inline void pierce(SurfaceMesh& mesh, int holes, std::mt19937& random) {
  for (int i = 0; i < holes && mesh.triangles.size() > 8; ++i) {
    mesh.triangles.erase(mesh.triangles.begin() +
                         static_cast<std::ptrdiff_t>(random() % mesh.triangles.size()));
  }
}

/// The triangles of a mesh by the places of their corners, degenerate ones left out: two meshes
/// with the same set are the same, whatever their numbers.
using Place = std::array<double, 3>;
inline std::multiset<std::array<Place, 3>> shape_of_mesh(const SurfaceMesh& mesh) {
  std::multiset<std::array<Place, 3>> result;
  for (const Corners& corners : mesh.triangles) {
    std::array<Place, 3> triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d& p = mesh.points[corners[k]];
      triangle[k] = {p.x(), p.y(), p.z()};
    }
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
      continue;
    }
    std::ranges::rotate(triangle, std::ranges::min_element(triangle));
    result.insert(triangle);
  }
  return result;
}

/// M_i of a sequence.
inline SurfaceMesh mesh_at(const LevelSequence& sequence, std::uint32_t level) {
  LevelRebuilder rebuilder(sequence);
  rebuilder.refine_to(level);
  return rebuilder.mesh();
}

}  // namespace terrane::hierarchy::testing

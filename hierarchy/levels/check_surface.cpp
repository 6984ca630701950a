#include "hierarchy/levels/check_surface.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

#include "core/errors.h"

namespace terrane::hierarchy {
namespace {

constexpr std::uint32_t kUnused = ~std::uint32_t{0};

/// Counts what is dropped and remembers the first.
struct Tally {
  std::size_t count = 0, first = 0;

  void add(std::size_t at) {
    if (count++ == 0) first = at;
  }
};

void note(const Tally& tally, std::string_view what, const std::string& name, Progress& progress) {
  if (tally.count == 0) return;
  progress.note(fmt::format("{}: {} {} (the first: {})", name, tally.count, what, tally.first));
}

/// Triangles with their index in the file.
struct Numbered {
  Corners corners;
  std::size_t number;
};

std::vector<Numbered> without_repeated_corners(const SurfaceMesh& mesh, const std::string& name,
                                               Progress& progress) {
  std::vector<Numbered> kept;
  Tally dropped;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [a, b, c] = mesh.triangles[t];
    if (a == b || b == c || c == a) {
      dropped.add(t);
    } else {
      kept.push_back({mesh.triangles[t], t});
    }
  }
  note(dropped, "triangles that repeat a corner are left out", name, progress);
  return kept;
}

std::vector<Numbered> without_duplicates(std::vector<Numbered> triangles, const std::string& name,
                                         Progress& progress) {
  const auto key = [](const Numbered& triangle) {
    Corners corners = triangle.corners;
    std::ranges::sort(corners);
    return std::tuple(corners, triangle.number);
  };
  std::ranges::sort(triangles, {}, key);
  Tally dropped;
  std::vector<Numbered> kept;
  for (const Numbered& triangle : triangles) {
    if (!kept.empty() && std::get<0>(key(kept.back())) == std::get<0>(key(triangle))) {
      dropped.add(triangle.number);
    } else {
      kept.push_back(triangle);
    }
  }
  std::ranges::sort(kept, {}, &Numbered::number);
  note(dropped, "triangles that are there twice are left out", name, progress);
  return kept;
}

void check_vertices(const SurfaceMesh& mesh, const std::vector<Numbered>& triangles,
                    const std::string& name) {
  for (const Numbered& triangle : triangles) {
    for (const std::uint32_t v : triangle.corners) {
      if (mesh.points[v].allFinite()) continue;
      throw TopologyError(fmt::format(
          "{}: vertex {} of triangle {} is not finite. Remove the vertex and its triangles", name,
          v, triangle.number));
    }
  }
}

struct Side {
  std::uint32_t low, high;
  bool is_forward;
  std::size_t triangle;
};

void check_edges(const std::vector<Numbered>& triangles, const std::string& name) {
  std::vector<Side> sides;
  for (const Numbered& triangle : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangle.corners[k], b = triangle.corners[(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), a < b, triangle.number});
    }
  }
  std::ranges::sort(sides, {}, [](const Side& s) { return std::tuple(s.low, s.high, s.triangle); });
  const auto is_same_edge = [&](std::size_t i, std::size_t j) {
    return j < sides.size() && sides[i].low == sides[j].low && sides[i].high == sides[j].high;
  };
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (is_same_edge(i, i + 2)) {
      throw TopologyError(
          fmt::format("{}: edge {}-{} has more than two triangles ({}, {}, {}). Cut the mesh "
                      "there: an edge of a "
                      "surface has two",
                      name, sides[i].low, sides[i].high, sides[i].triangle, sides[i + 1].triangle,
                      sides[i + 2].triangle));
    }
    if (is_same_edge(i, i + 1) && sides[i].is_forward == sides[i + 1].is_forward) {
      throw TopologyError(fmt::format(
          "{}: triangles {} and {} face opposite sides at edge {}-{}. Orient the mesh consistently",
          name, sides[i].triangle, sides[i + 1].triangle, sides[i].low, sides[i].high));
    }
  }
}

/// Renumbers the vertices in use, in their order.
SurfaceMesh compacted(const SurfaceMesh& mesh, const std::vector<Numbered>& triangles,
                      const std::string& name, Progress& progress) {
  std::vector<std::uint32_t> number(mesh.points.size(), kUnused);
  for (const Numbered& triangle : triangles) {
    for (const std::uint32_t v : triangle.corners) number[v] = 0;
  }
  SurfaceMesh result;
  Tally unused;
  for (std::uint32_t v = 0; v < number.size(); ++v) {
    if (number[v] == kUnused) {
      unused.add(v);
      continue;
    }
    number[v] = static_cast<std::uint32_t>(result.points.size());
    result.points.push_back(mesh.points[v]);
    if (!mesh.colours.empty()) result.colours.push_back(mesh.colours[v]);
  }
  for (const Numbered& triangle : triangles) {
    result.triangles.push_back(triangle.corners);
    for (std::uint32_t& v : result.triangles.back()) v = number[v];
  }
  note(unused, "vertices that no triangle uses are left out", name, progress);
  return result;
}

void note_flat_triangles(const SurfaceMesh& mesh, const std::vector<Numbered>& triangles,
                         const std::string& name, Progress& progress) {
  Tally flat;
  for (const Numbered& triangle : triangles) {
    const auto [a, b, c] = triangle.corners;
    const Eigen::Vector3d side = mesh.points[b] - mesh.points[a];
    const Eigen::Vector3d other = mesh.points[c] - mesh.points[a];
    if (side.cross(other).isZero(0)) flat.add(triangle.number);
  }
  note(flat, "triangles have no area and stay until a neighbour collapses", name, progress);
}

void note_components(const SurfaceMesh& mesh, const std::string& name, Progress& progress) {
  std::vector<std::uint32_t> root(mesh.points.size());
  std::iota(root.begin(), root.end(), 0U);
  const auto find = [&root](std::uint32_t v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  std::size_t count = mesh.points.size();
  for (const Corners& corners : mesh.triangles) {
    for (const std::uint32_t v : {corners[1], corners[2]}) {
      const std::uint32_t a = find(corners[0]), b = find(v);
      if (a == b) continue;
      root[std::max(a, b)] = std::min(a, b);
      --count;
    }
  }
  if (count > 1) {
    progress.note(fmt::format("{}: {} components; each keeps to itself", name, count));
  }
}

}  // namespace

SurfaceMesh check_surface(SurfaceMesh mesh, const std::string& name, Progress& progress) {
  auto triangles =
      without_duplicates(without_repeated_corners(mesh, name, progress), name, progress);
  if (triangles.empty()) {
    throw TopologyError(fmt::format("{}: no triangle is left. Name a file with a mesh", name));
  }
  check_vertices(mesh, triangles, name);
  check_edges(triangles, name);
  note_flat_triangles(mesh, triangles, name, progress);
  SurfaceMesh result = compacted(mesh, triangles, name, progress);
  note_components(result, name, progress);
  return result;
}

}  // namespace terrane::hierarchy

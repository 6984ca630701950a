#include "tiler/verify/tile_examination.h"

#include <fmt/format.h>

#include <algorithm>

namespace terrane::verify {
namespace {

LatticeTriangle smallest_first(LatticeTriangle triangle) {
  std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
  return triangle;
}

bool has_area(const LatticeTriangle& triangle) {
  const auto& [a, b, c] = triangle;
  const Lattice u = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  const Lattice v = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  return u[1] * v[2] != u[2] * v[1] || u[2] * v[0] != u[0] * v[2] || u[0] * v[1] != u[1] * v[0];
}

std::vector<LatticeTriangle> triangles_at_rest(const TileMesh& mesh) {
  std::vector<LatticeTriangle> triangles;
  for (const auto& [a, b, c] : mesh.triangles) {
    triangles.push_back(smallest_first({mesh.position[a], mesh.position[b], mesh.position[c]}));
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

std::vector<LatticeTriangle> triangles_at_next_level(const TileMesh& mesh) {
  std::vector<LatticeTriangle> triangles;
  for (const auto& [a, b, c] : mesh.triangles) {
    const LatticeTriangle triangle = {mesh.target(a), mesh.target(b), mesh.target(c)};
    if (has_area(triangle)) triangles.push_back(smallest_first(triangle));
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

void count_folds(TileFindings& findings, bool is_root) {
  const PlacedMesh& placed = *findings.placed;
  for (std::size_t time = 0; time < (is_root ? 1 : kTimeCount); ++time) {
    findings.folded[time] = placed.count_folded(time_at(time));
    if (findings.folded[time] == 0) continue;
    const std::int64_t first = placed.first_folded(time_at(time));
    const auto corner = placed.mesh().triangles[static_cast<std::size_t>(first)][0];
    const GridPosition at = placed.grid_position(corner, time_at(time));
    findings.problems.push_back(fmt::format(
        "{}: {} triangles folded at t = {}, the first at (column {:.2f}, row {:.2f})",
        to_string(findings.key), findings.folded[time], time_at(time), at.column, at.row));
  }
}

/// \param step_m  of the tile's level.
void check_box(TileFindings& findings, const Box& box, const Eigen::Vector3d& step_m) {
  const PlacedMesh& placed = *findings.placed;
  for (std::uint32_t vertex = 0; vertex < placed.mesh().position.size(); ++vertex) {
    const bool is_inside =
        box.contains(placed.corner(vertex, 0)) && box.contains(placed.corner(vertex, 1));
    findings.vertices_outside_box += !is_inside;
  }
  for (const Lattice& point : placed.mesh().hem) {
    const Eigen::Vector3d at = Eigen::Map<const Eigen::Matrix<std::int64_t, 3, 1>>(point.data())
                                   .cast<double>()
                                   .cwiseProduct(step_m);
    findings.vertices_outside_box += !box.contains(at);
  }
  if (findings.vertices_outside_box > 0) {
    findings.problems.push_back(fmt::format("{}: its box lacks {} of its vertices",
                                            to_string(findings.key),
                                            findings.vertices_outside_box));
  }
}

void check_water(TileFindings& findings, const LevelEntry& level, const WaterJudge& water) {
  const std::vector<bool>& in_water = findings.placed->mesh().in_water;
  findings.water_triangles = std::count(in_water.begin(), in_water.end(), true);
  findings.uneven_water_triangles =
      water.count_uneven(*findings.placed, level.step_m, level.tolerance_m);
  if (findings.uneven_water_triangles == 0) return;
  findings.problems.push_back(
      fmt::format("{}: {} triangles of water are not at the height of a lake there",
                  to_string(findings.key), findings.uneven_water_triangles));
}

void check_facts(TileFindings& findings, const TileEntry& entry) {
  const TileMesh& mesh = findings.placed->mesh();
  findings.misstated = mesh.misstated;
  const auto triangles = static_cast<std::int64_t>(mesh.triangles.size());
  if (entry.triangles != triangles) {
    findings.misstated.push_back(
        fmt::format("{} triangles stated, {} found", entry.triangles, triangles));
  }
  if (entry.bytes != mesh.bytes) {
    findings.misstated.push_back(fmt::format("{} bytes stated, {} found", entry.bytes, mesh.bytes));
  }
}

}  // namespace

TileFindings examine_tile(const Output& output, const World& world, const ValidDomain& domain,
                          const WaterJudge& water, const TileKey& key) {
  TileFindings findings{.key = key};
  const TileEntry* entry = output.find(key);
  if (entry == nullptr) return findings;
  const bool is_root = key.level + 1 == static_cast<int>(output.levels.size());
  findings.placed = std::make_unique<PlacedMesh>(read_tile_mesh(output, key), output, world);
  const TileMesh& mesh = findings.placed->mesh();
  const Boundary boundary = find_boundary(mesh);
  findings.torn_edges = boundary.torn;
  if (boundary.torn > 0) {
    findings.problems.push_back(
        fmt::format("{}: {} edges torn or doubled inside", to_string(key), boundary.torn));
  }
  findings.vertices_with_morph = std::count_if(mesh.morph.begin(), mesh.morph.end(),
                                               [](const Lattice& m) { return m != Lattice{}; });
  findings.sides = side_vertices(*findings.placed, boundary, output.tiling.window(key), domain,
                                 output.levels[static_cast<std::size_t>(key.level)].plan_step_m());
  findings.at_rest = triangles_at_rest(mesh);
  if (!is_root) findings.at_next_level = triangles_at_next_level(mesh);
  count_folds(findings, is_root);
  check_box(findings, entry->box, output.levels[static_cast<std::size_t>(key.level)].step_m);
  check_water(findings, output.levels[static_cast<std::size_t>(key.level)], water);
  check_facts(findings, *entry);
  return findings;
}

}  // namespace terrane::verify

#include "tiler/verify/border.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <tuple>

namespace terrane::verify {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

constexpr double kSeamWidth_steps = 2;  // how far off the line a seam vertex may be rounded
constexpr double kLocatorSlack_m = 1e-3;

/// Numbers the vertices so that equal keys get equal numbers.
template <typename Key, typename KeyOf>
std::vector<std::uint32_t> numbered(std::size_t count, KeyOf key_of) {
  std::map<Key, std::uint32_t> numbers;
  std::vector<std::uint32_t> result;
  for (std::size_t v = 0; v < count; ++v) {
    result.push_back(
        numbers.emplace(key_of(v), static_cast<std::uint32_t>(numbers.size())).first->second);
  }
  return result;
}

std::vector<Edge> sorted_edges(const TileMesh& mesh, const std::vector<std::uint32_t>& numbers) {
  std::vector<Edge> edges;
  for (const auto& [a, b, c] : mesh.triangles) {
    edges.insert(edges.end(),
                 {{numbers[a], numbers[b]}, {numbers[b], numbers[c]}, {numbers[c], numbers[a]}});
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

bool has_edge(const std::vector<Edge>& edges, std::uint32_t from, std::uint32_t to) {
  return std::binary_search(edges.begin(), edges.end(), Edge{from, to});
}

std::int64_t count_repeated(const std::vector<Edge>& edges) {
  std::int64_t repeated = 0;
  for (std::size_t n = 1; n < edges.size(); ++n) repeated += edges[n] == edges[n - 1];
  return repeated;
}

SeamVertices as_set(SeamVertices vertices) {
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

/// Decides which boundary edges run along a line.
class SeamFilter {
 public:
  SeamFilter(const GridLocator& locator, const Line& line, const std::vector<Run>& runs,
             double step_m)
      : line_(line), runs_(runs) {
    const double width_m = kSeamWidth_steps * step_m + kLocatorSlack_m;
    column_slack_ = width_m / locator.column_size_m();
    row_slack_ = width_m / locator.row_size_m();
  }

  double along(const GridPosition& at) const { return line_.is_column ? at.row : at.column; }

  bool runs_along(const GridPosition& a, const GridPosition& b) const {
    if (!is_on_line(a) || !is_on_line(b)) return false;
    const double slack = line_.is_column ? row_slack_ : column_slack_;
    const double low = std::min(along(a), along(b)) + slack;
    const double high = std::max(along(a), along(b)) - slack;
    return std::any_of(runs_.begin(), runs_.end(), [&](const Run& run) {
      return low >= static_cast<double>(run.first) && high <= static_cast<double>(run.second);
    });
  }

 private:
  bool is_on_line(const GridPosition& at) const {
    const double off = (line_.is_column ? at.column : at.row) - static_cast<double>(line_.at);
    return std::abs(off) <= (line_.is_column ? column_slack_ : row_slack_);
  }

  const Line& line_;
  const std::vector<Run>& runs_;
  double column_slack_;
  double row_slack_;
};

/// Exact grid positions of the vertices that boundary edges end at.
std::map<std::uint32_t, GridPosition> locate_exactly(const PlacedMesh& mesh,
                                                     const Boundary& boundary) {
  std::set<std::uint32_t> vertices;
  for (const auto& edge : boundary.edges) vertices.insert(edge.begin(), edge.end());
  std::vector<Eigen::Vector3d> points;
  std::vector<GridPosition> positions;
  for (const std::uint32_t vertex : vertices) {
    points.push_back(mesh.corner(vertex, 0));
    positions.push_back(mesh.grid_position(vertex, 0));
  }
  mesh.locator().refine(points, positions);
  std::map<std::uint32_t, GridPosition> located;
  auto position = positions.begin();
  for (const std::uint32_t vertex : vertices) located[vertex] = *position++;
  return located;
}

SeamVertices seam_vertices(const TileMesh& mesh, const std::map<std::uint32_t, GridPosition>& at,
                           const Boundary& boundary, const SeamFilter& filter) {
  SeamVertices vertices;
  for (const auto& edge : boundary.edges) {
    if (!filter.runs_along(at.at(edge[0]), at.at(edge[1]))) continue;
    for (const std::uint32_t vertex : edge) {
      vertices.push_back({mesh.position[vertex], mesh.morph[vertex], filter.along(at.at(vertex))});
    }
  }
  return as_set(std::move(vertices));
}

}  // namespace

Boundary find_boundary(const TileMesh& mesh) {
  const auto places =
      numbered<Lattice>(mesh.position.size(), [&](std::size_t v) { return mesh.position[v]; });
  const auto moving = numbered<std::pair<Lattice, Lattice>>(
      mesh.position.size(),
      [&](std::size_t v) { return std::pair(mesh.position[v], mesh.morph[v]); });
  const std::vector<Edge> edges_at_rest = sorted_edges(mesh, places);
  const std::vector<Edge> edges_moving = sorted_edges(mesh, moving);
  Boundary boundary{.torn = count_repeated(edges_at_rest)};
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t n = 0; n < 3; ++n) {
      const std::uint32_t from = triangle[n];
      const std::uint32_t to = triangle[(n + 1) % 3];
      if (!has_edge(edges_at_rest, places[to], places[from])) {
        boundary.edges.push_back({from, to});
      } else if (!has_edge(edges_moving, moving[to], moving[from])) {
        ++boundary.torn;
      }
    }
  }
  return boundary;
}

std::array<SeamVertices, 4> side_vertices(const PlacedMesh& mesh, const Boundary& boundary,
                                          const Window& tile_window, const ValidDomain& domain,
                                          double step_m) {
  const auto located = locate_exactly(mesh, boundary);
  std::array<SeamVertices, 4> sides;
  for (const Side side : kSides) {
    const Line line = side_line(tile_window, side);
    const std::vector<Run> runs = domain.shared_runs(line);
    if (runs.empty()) continue;
    const SeamFilter filter(mesh.locator(), line, runs, step_m);
    sides[static_cast<std::size_t>(side)] = seam_vertices(mesh.mesh(), located, boundary, filter);
  }
  return sides;
}

SeamVertices at_next_level(const SeamVertices& vertices) {
  SeamVertices moved = vertices;
  for (SeamVertex& vertex : moved) {
    vertex.place = vertex.place + vertex.morph;
    vertex.morph = {};
  }
  return as_set(std::move(moved));
}

SeamVertices difference(const SeamVertices& a, const SeamVertices& b) {
  SeamVertices only;
  std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(only));
  return only;
}

SeamVertices unite(const SeamVertices& a, const SeamVertices& b) {
  SeamVertices both;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

}  // namespace terrane::verify

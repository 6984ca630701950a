#include "hierarchy/levels/level_sequence.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/errors.h"

namespace terrane::hierarchy {
namespace {

[[noreturn]] void damaged(const Collapse& collapse) {
  throw InputError(fmt::format(
      "the collapse of vertices {}, {} and {} does not fit its mesh: the sequence is damaged. "
      "Build it again",
      collapse.corners[0], collapse.corners[1], collapse.corners[2]));
}

}  // namespace

LevelRebuilder::LevelRebuilder(const LevelSequence& sequence)
    : sequence_(sequence),
      level_(sequence.level_count()),
      points_(sequence.coarsest_points),
      incident_(sequence.coarsest_points.size()) {
  for (const Corners& corners : sequence.coarsest_triangles) add_triangle(corners);
}

void LevelRebuilder::add_triangle(const Corners& corners) {
  for (const std::uint32_t v : corners) {
    incident_[v].push_back(static_cast<std::uint32_t>(triangles_.size()));
  }
  triangles_.push_back(corners);
}

std::vector<LevelRebuilder::LinkEdge> LevelRebuilder::link_edges(std::uint32_t vertex) const {
  std::vector<LinkEdge> edges;
  edges.reserve(incident_[vertex].size());
  for (const std::uint32_t t : incident_[vertex]) {
    const Corners& c = triangles_[t];
    const std::size_t k = c[0] == vertex ? 0 : c[1] == vertex ? 1 : 2;
    edges.push_back({c[(k + 1) % 3], c[(k + 2) % 3], t});
  }
  // start: the edge that no other leads to; on a closed ring the one from the smallest number
  auto first = std::ranges::min_element(edges, {}, &LinkEdge::from);
  for (auto edge = edges.begin(); edge != edges.end(); ++edge) {
    if (std::ranges::find(edges, edge->from, &LinkEdge::to) == edges.end()) first = edge;
  }
  std::iter_swap(edges.begin(), first);
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const auto begin = edges.begin() + static_cast<std::ptrdiff_t>(i);
    const auto next = std::find_if(
        begin, edges.end(), [&](const LinkEdge& edge) { return edge.from == edges[i - 1].to; });
    if (next == edges.end()) throw InputError("a vertex has several fans: the sequence is damaged");
    std::iter_swap(begin, next);
  }
  return edges;
}

std::vector<std::uint32_t> LevelRebuilder::link(std::uint32_t vertex) const {
  std::vector<std::uint32_t> result;
  const auto edges = link_edges(vertex);
  for (const LinkEdge& edge : edges) result.push_back(edge.from);
  if (!edges.empty() && edges.back().to != edges.front().from) result.push_back(edges.back().to);
  return result;
}

void LevelRebuilder::check(const Collapse& collapse) const {
  const auto next = static_cast<std::uint32_t>(points_.size());
  if (collapse.corners[0] >= next || collapse.corners[1] != next ||
      collapse.corners[2] != next + 1 || incident_[collapse.corners[0]].empty()) {
    damaged(collapse);
  }
}

/// Gives the triangles about p0 to the corner that they had before the collapse.
void LevelRebuilder::deal_out(const Collapse& collapse) {
  const std::uint32_t centre = collapse.corners[0];
  std::vector<LinkEdge> ring = link_edges(centre);
  // close an open fan through the outside, so that both kinds are walked alike
  if (ring.back().to != ring.front().from) {
    const std::uint32_t first = ring.front().from;
    ring.push_back({ring.back().to, kOutside, kOutside});
    ring.push_back({kOutside, first, kOutside});
  }
  incident_[centre].clear();
  std::size_t dealt = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t begin = collapse.apexes[k], end = collapse.apexes[(k + 1) % 3];
    const std::uint32_t owner = collapse.corners[(k + 1) % 3];
    if (begin == end) continue;
    auto at = std::ranges::find(ring, begin, &LinkEdge::from);
    if (at == ring.end()) damaged(collapse);
    for (std::size_t steps = 0;; ++steps) {
      if (steps > ring.size()) damaged(collapse);
      if (at->triangle != kOutside) {
        std::ranges::replace(triangles_[at->triangle], centre, owner);
        incident_[owner].push_back(at->triangle);
        ++dealt;
      }
      const std::uint32_t reached = at->to;
      if (++at == ring.end()) at = ring.begin();
      if (reached == end) break;
    }
  }
  if (dealt + (std::ranges::count(ring, kOutside, &LinkEdge::triangle)) != ring.size()) {
    damaged(collapse);
  }
}

void LevelRebuilder::split(const Collapse& collapse) {
  check(collapse);
  points_[collapse.corners[0]] = collapse.before[0];
  for (std::size_t k = 1; k < 3; ++k) {
    points_.push_back(collapse.before[k]);
    incident_.emplace_back();
  }
  deal_out(collapse);
  add_triangle(collapse.corners);
  for (std::size_t k = 0; k < 3; ++k) {
    if (collapse.apexes[k] == kOutside) continue;
    add_triangle({collapse.corners[(k + 1) % 3], collapse.corners[k], collapse.apexes[k]});
  }
}

void LevelRebuilder::refine() {
  for (const Collapse& collapse : sequence_.levels[level_ - 1]) split(collapse);
  --level_;
}

void LevelRebuilder::refine_to(std::uint32_t level) {
  while (level_ > level) refine();
}

SurfaceMesh LevelRebuilder::mesh() const {
  SurfaceMesh mesh{{}, triangles_};
  mesh.points.reserve(points_.size());
  for (const Eigen::Vector3i& p : points_) {
    mesh.points.push_back(sequence_.lattice.origin() + sequence_.lattice.relative(p));
  }
  return mesh;
}

namespace {

void check_level(const LevelSequence& sequence, std::uint32_t level) {
  if (level > sequence.level_count()) {
    throw ConfigError(
        fmt::format("level {}: the sequence ends at level {}", level, sequence.level_count()));
  }
}

}  // namespace

SurfaceMesh blended(const LevelSequence& sequence, std::uint32_t level, double t) {
  check_level(sequence, level);
  if (!(t >= 0 && t <= 1)) throw ConfigError(fmt::format("blend {}: has to lie in 0 to 1", t));
  LevelRebuilder rebuilder(sequence);
  rebuilder.refine_to(level);
  SurfaceMesh mesh = rebuilder.mesh();
  if (level == sequence.level_count()) return mesh;
  const PointLattice& lattice = sequence.lattice;
  for (const Collapse& collapse : sequence.levels[level]) {
    const Eigen::Vector3d c = lattice.relative(collapse.after);
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d p = lattice.relative(collapse.before[k]);
      mesh.points[collapse.corners[k]] = lattice.origin() + (p + t * (c - p));
    }
  }
  return mesh;
}

MorphingMesh morphing(const LevelSequence& sequence, std::uint32_t level, std::uint32_t by) {
  check_level(sequence, level);
  const std::uint32_t last = std::min(sequence.level_count(), level + by);
  LevelRebuilder rebuilder(sequence);
  rebuilder.refine_to(last);
  const std::vector<Eigen::Vector3i> coarse = rebuilder.points();
  rebuilder.refine_to(level);

  // a vertex ends where the one ends that it was collapsed into; those of M_last are their own
  std::vector<std::uint32_t> target(rebuilder.points().size());
  for (std::uint32_t v = 0; v < coarse.size(); ++v) target[v] = v;
  for (std::uint32_t i = last; i-- > level;) {
    for (const Collapse& collapse : sequence.levels[i]) {
      target[collapse.corners[1]] = target[collapse.corners[2]] = target[collapse.corners[0]];
    }
  }
  MorphingMesh result{rebuilder.mesh(), {}};
  for (const std::uint32_t v : target) {
    result.targets.push_back(sequence.lattice.origin() + sequence.lattice.relative(coarse[v]));
  }
  return result;
}

}  // namespace terrane::hierarchy

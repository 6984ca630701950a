#include "hierarchy/mesh/halfedge_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <numeric>

#include "core/errors.h"

namespace terrane::hierarchy {
namespace {

/// A half-edge, listed with the vertex that it starts at.
struct Arrow {
  std::uint32_t end;
  HalfedgeId halfedge;
};

/// The half-edges that start at each vertex.
class Outgoing {
 public:
  Outgoing(std::uint32_t vertex_count, std::span<const Corners> triangles)
      : begin_(vertex_count + 1, 0), arrows_(3 * triangles.size()) {
    for (const Corners& corners : triangles) {
      for (const std::uint32_t v : corners) ++begin_[v + 1];
    }
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    std::vector<std::uint32_t> free(begin_.begin(), begin_.end() - 1);
    std::uint32_t halfedge = 0;
    for (const Corners& corners : triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        arrows_[free[corners[k]]++] = {corners[(k + 1) % 3], HalfedgeId{halfedge++}};
      }
    }
  }

  std::span<const Arrow> of(std::uint32_t v) const {
    return std::span(arrows_).subspan(begin_[v], begin_[v + 1] - begin_[v]);
  }

 private:
  std::vector<std::uint32_t> begin_;
  std::vector<Arrow> arrows_;
};

void check_ends_differ(std::uint32_t start, std::span<const Arrow> arrows) {
  for (std::size_t i = 0; i < arrows.size(); ++i) {
    const std::uint32_t end = arrows[i].end;
    if (std::ranges::find(arrows.subspan(i + 1), end, &Arrow::end) == arrows.end()) continue;
    throw TopologyError(fmt::format(
        "edge {}-{}: has more than two triangles, or two that do not agree in orientation",
        std::min(start, end), std::max(start, end)));
  }
}

void check_corners(std::span<const Corners> triangles, std::uint32_t vertex_count) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto [a, b, c] = triangles[t];
    if (a == b || b == c || c == a) {
      throw TopologyError(fmt::format("triangle {}: repeats a corner ({}, {}, {})", t, a, b, c));
    }
    if (std::max({a, b, c}) >= vertex_count) {
      throw TopologyError(
          fmt::format("triangle {}: names vertex {} of {}", t, std::max({a, b, c}), vertex_count));
    }
  }
}

}  // namespace

HalfedgeMesh::HalfedgeMesh(std::uint32_t vertex_count, std::span<const Corners> triangles)
    : vertex_count_(vertex_count),
      live_triangles_(static_cast<std::uint32_t>(triangles.size())),
      start_(triangles.size() * 3),
      opposite_(triangles.size() * 3, kNoHalfedge),
      live_(triangles.size(), 1),
      outgoing_(vertex_count, kNoHalfedge),
      origin_(vertex_count),
      split_(vertex_count, false) {
  check_corners(triangles, vertex_count);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      start_[halfedge(TriangleId{t}, k)] = VertexId{triangles[t][k]};
    }
  }
  for (std::uint32_t v = 0; v < vertex_count; ++v) origin_[VertexId{v}] = v;
  pair_edges(triangles);
  split_fans();
  close_boundaries();
  count_valences();
}

void HalfedgeMesh::pair_edges(std::span<const Corners> triangles) {
  const Outgoing outgoing(vertex_count_, triangles);
  for (std::uint32_t v = 0; v < vertex_count_; ++v) {
    const std::span<const Arrow> arrows = outgoing.of(v);
    check_ends_differ(v, arrows);
    for (const auto& [end, halfedge] : arrows) {
      if (end < v) continue;  // from the end with the smaller number
      const auto there = outgoing.of(end);
      const auto back = std::ranges::find(there, v, &Arrow::end);
      if (back == there.end()) continue;
      opposite_[halfedge] = back->halfedge;
      opposite_[back->halfedge] = halfedge;
    }
  }
}

void HalfedgeMesh::split_fans() {
  std::vector<bool> claimed(start_.size(), false);
  for (std::uint32_t i = 0; i < start_.size(); ++i) {
    if (!claimed[i]) claim_fan(HalfedgeId{i}, claimed);
  }
}

void HalfedgeMesh::claim_fan(HalfedgeId first, std::vector<bool>& claimed) {
  // clockwise to the boundary, if there is one: the fan is then open and begins there
  for (HalfedgeId h = first; opposite_[h] != kNoHalfedge;) {
    h = next(opposite_[h]);
    if (h == first) break;
    if (opposite_[h] == kNoHalfedge) {
      first = h;
      break;
    }
  }
  VertexId vertex = start(first);
  if (outgoing_[vertex] != kNoHalfedge) {
    split_[origin_[vertex]] = true;
    origin_.push_back(origin_[vertex]);
    outgoing_.push_back(kNoHalfedge);
    vertex = VertexId{vertex_count_++};
  }
  outgoing_[vertex] = first;
  for (HalfedgeId h = first;;) {
    claimed[index(h)] = true;
    start_[h] = vertex;
    h = opposite_[prev(h)];
    if (h == kNoHalfedge || h == first) return;
  }
}

void HalfedgeMesh::close_boundaries() {
  const auto given = static_cast<std::uint32_t>(start_.size());
  for (std::uint32_t i = 0; i < given; ++i) {
    if (opposite_[HalfedgeId{i}] == kNoHalfedge) close_loop(HalfedgeId{i});
  }
}

HalfedgeId HalfedgeMesh::next_boundary(HalfedgeId h) const {
  h = next(h);
  while (opposite_[h] != kNoHalfedge) h = next(opposite_[h]);
  return h;
}

/// Adds the fan of ghost triangles (end, start, infinity) over the boundary loop of first.
void HalfedgeMesh::close_loop(HalfedgeId first) {
  const VertexId infinity{static_cast<std::uint32_t>(outgoing_.size())};
  std::vector<HalfedgeId> loop;
  HalfedgeId h = first;
  do {
    loop.push_back(h);
    h = next_boundary(h);
  } while (h != first);

  const std::uint32_t first_ghost = triangle_count();
  for (const HalfedgeId side : loop) {
    start_.push_back(end(side));
    start_.push_back(start(side));
    start_.push_back(infinity);
    live_.push_back(1);
    for (int k = 0; k < 3; ++k) opposite_.push_back(kNoHalfedge);
  }
  const auto count = static_cast<std::uint32_t>(loop.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    const TriangleId ghost{first_ghost + i};
    const TriangleId after{first_ghost + (i + 1) % count};
    opposite_[loop[i]] = halfedge(ghost, 0);
    opposite_[halfedge(ghost, 0)] = loop[i];
    // the loop runs on from end(loop[i]), where this ghost's side from infinity ends
    opposite_[halfedge(ghost, 2)] = halfedge(after, 1);
    opposite_[halfedge(after, 1)] = halfedge(ghost, 2);
  }
  outgoing_.push_back(halfedge(TriangleId{first_ghost}, 2));
  origin_.push_back(static_cast<std::uint32_t>(infinity));
}

void HalfedgeMesh::count_valences() {
  valence_ = IdVector<VertexId, std::uint32_t>(outgoing_.size(), 0);
  for (const VertexId v : start_) ++valence_[v];
}

bool HalfedgeMesh::is_boundary(VertexId v) const {
  const HalfedgeId first = outgoing(v);
  if (first == kNoHalfedge) return false;
  HalfedgeId h = first;
  do {
    if (is_ghost(end(h))) return true;
    h = rotate(h);
  } while (h != first);
  return false;
}

void HalfedgeMesh::kill(TriangleId t) {
  assert(is_live(t));
  if (!is_ghost(t)) --live_triangles_;
  live_[t] = 0;
}

void HalfedgeMesh::collapse(std::span<const HalfedgeId> spokes, std::span<const HalfedgeId> dying,
                            VertexId kept) {
  const bool is_triangle = dying.size() == 3;
  std::uint32_t valence = 0;
  for (const HalfedgeId h : dying) valence += valence_[start(h)];
  if (is_triangle) kill(triangle(opposite(dying[0])));

  for (const HalfedgeId h : dying) {
    const HalfedgeId out = opposite(next(h));
    const HalfedgeId in = opposite(prev(h));
    const VertexId apex_vertex = apex(h);
    opposite_[out] = in;
    opposite_[in] = out;
    outgoing_[apex_vertex] = out;
    --valence_[apex_vertex];
  }
  for (const HalfedgeId h : dying) kill(triangle(h));
  for (const HalfedgeId h : dying) outgoing_[start(h)] = kNoHalfedge;
  for (const HalfedgeId h : spokes) start_[h] = kept;
  outgoing_[kept] = spokes[0];
  valence_[kept] = valence - (is_triangle ? 9 : 4);
}

void HalfedgeMesh::flip(HalfedgeId h) {
  const HalfedgeId o = opposite(h);
  const VertexId a = start(h), b = start(o), c = apex(h), d = apex(o);
  const HalfedgeId beyond_bc = opposite(next(h)), beyond_ca = opposite(prev(h));
  const HalfedgeId beyond_ad = opposite(next(o)), beyond_db = opposite(prev(o));
  const auto join = [this](HalfedgeId inside, VertexId from, HalfedgeId beyond) {
    start_[inside] = from;
    opposite_[inside] = beyond;
    opposite_[beyond] = inside;
    outgoing_[from] = inside;
  };
  start_[h] = d;
  start_[o] = c;
  join(next(h), c, beyond_ca);
  join(prev(h), a, beyond_ad);
  join(next(o), d, beyond_db);
  join(prev(o), b, beyond_bc);
  --valence_[a];
  --valence_[b];
  ++valence_[c];
  ++valence_[d];
}

Survivors HalfedgeMesh::compact() {
  Survivors old;
  IdVector<VertexId, VertexId> new_vertex(outgoing_.size());
  IdVector<TriangleId, std::uint32_t> new_triangle(triangle_count());
  for (std::uint32_t i = 0; i < outgoing_.size(); ++i) {
    const VertexId v{i};
    if (!is_ghost(v) && outgoing_[v] == kNoHalfedge) continue;
    new_vertex[v] = VertexId{static_cast<std::uint32_t>(old.vertices.size())};
    old.vertices.push_back(v);
  }
  for (std::uint32_t i = 0; i < triangle_count(); ++i) {
    if (!is_live(TriangleId{i})) continue;
    new_triangle[TriangleId{i}] = static_cast<std::uint32_t>(old.triangles.size());
    old.triangles.push_back(TriangleId{i});
  }
  const auto renumbered = [&](HalfedgeId h) {
    return h == kNoHalfedge
               ? h
               : halfedge(TriangleId{new_triangle[triangle(h)]}, static_cast<std::uint32_t>(h) % 3);
  };
  std::uint32_t end = 0;
  for (const TriangleId t : old.triangles) {
    for (std::uint32_t k = 0; k < 3; ++k, ++end) {
      start_[HalfedgeId{end}] = new_vertex[start_[halfedge(t, k)]];
      opposite_[HalfedgeId{end}] = renumbered(opposite_[halfedge(t, k)]);
    }
  }
  start_.resize(end);
  opposite_.resize(end);
  live_.keep(old.triangles);
  outgoing_.keep(old.vertices);
  for (HalfedgeId& h : outgoing_) h = renumbered(h);
  valence_.keep(old.vertices);
  origin_.keep(old.vertices);
  const auto first_ghost = std::ranges::lower_bound(old.vertices, VertexId{vertex_count_});
  vertex_count_ = static_cast<std::uint32_t>(first_ghost - old.vertices.begin());
  return old;
}

std::vector<Corners> HalfedgeMesh::triangles() const {
  std::vector<Corners> result;
  result.reserve(live_triangles_);
  for (std::uint32_t i = 0; i < triangle_count(); ++i) {
    const TriangleId t{i};
    if (!is_live(t) || is_ghost(t)) continue;
    Corners corners;
    for (std::uint32_t k = 0; k < 3; ++k) {
      corners[k] = static_cast<std::uint32_t>(start_[halfedge(t, k)]);
    }
    result.push_back(corners);
  }
  return result;
}

}  // namespace terrane::hierarchy

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/mesh/ids.h"

namespace terrane::hierarchy {

/// Corners of a triangle, counter-clockwise.
using Corners = std::array<std::uint32_t, 3>;

/// What HalfedgeMesh::compact() leaves: the old id of each new one, ascending.
struct Survivors {
  std::vector<VertexId> vertices;  ///< ghosts included, last
  std::vector<TriangleId> triangles;
};

/// Half-edges of an orientable triangle mesh in flat arrays, made for collapses.
///
/// Every edge has two triangles: along a boundary loop stand *ghost triangles* that join each
/// boundary edge to the loop's point at infinity, a *ghost vertex* (P1, section 3). So a stencil at
/// the border is as complete as one inside.
///
///            apex                 half-edge h of triangle t: from start(h) to end(h),
///            /  \                 the triangle on its left
///     prev  /    \  next
///          / t    \               outgoing half-edges of a vertex in counter-clockwise order:
///     start ──h──▶ end            h, opposite(prev(h)), ...
///
/// Guarantees: a vertex has one fan of triangles. A collapse never allocates: it kills triangles
/// and vertices in place and leaves the other ids as they are.
class HalfedgeMesh {
 public:
  /// Builds the mesh of a list of triangles.
  ///
  /// A vertex where several fans meet (two holes that touch in a point) is split: each further fan
  /// gets a vertex of its own after the given ones, see origin().
  /// \param vertex_count  vertices are 0 ... vertex_count - 1; they need not all be used.
  /// \throws TopologyError if an edge has more than two triangles or two of equal orientation, or a
  ///         triangle repeats a corner.
  HalfedgeMesh(std::uint32_t vertex_count, std::span<const Corners> triangles);

  std::uint32_t vertex_count() const { return vertex_count_; }  ///< with split ones, less ghosts
  std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(start_.size() / 3); }
  std::uint32_t live_triangle_count() const { return live_triangles_; }  ///< less ghosts

  /// The given vertex that v is, or was split from.
  std::uint32_t origin(VertexId v) const { return origin_[v]; }
  /// Was v's given vertex split into several?
  bool is_split(VertexId v) const { return split_[origin(v)]; }

  bool is_ghost(VertexId v) const { return index(v) >= vertex_count_; }
  bool is_ghost(TriangleId t) const {
    return is_ghost(start_[halfedge(t, 0)]) || is_ghost(start_[halfedge(t, 1)]) ||
           is_ghost(start_[halfedge(t, 2)]);
  }
  bool is_live(TriangleId t) const { return live_[t]; }
  /// Does v touch the boundary?
  bool is_boundary(VertexId v) const;

  static TriangleId triangle(HalfedgeId h) { return TriangleId{static_cast<std::uint32_t>(h) / 3}; }
  static HalfedgeId halfedge(TriangleId t, std::uint32_t side) {
    return HalfedgeId{static_cast<std::uint32_t>(t) * 3 + side};
  }
  static HalfedgeId next(HalfedgeId h) { return index(h) % 3 == 2 ? offset(h, -2) : offset(h, 1); }
  static HalfedgeId prev(HalfedgeId h) { return index(h) % 3 == 0 ? offset(h, 2) : offset(h, -1); }

  HalfedgeId opposite(HalfedgeId h) const { return opposite_[h]; }
  VertexId start(HalfedgeId h) const { return start_[h]; }
  VertexId end(HalfedgeId h) const { return start_[next(h)]; }
  VertexId apex(HalfedgeId h) const { return start_[prev(h)]; }
  std::array<VertexId, 3> corners(TriangleId t) const {
    return {start_[halfedge(t, 0)], start_[halfedge(t, 1)], start_[halfedge(t, 2)]};
  }
  /// The next outgoing half-edge of start(h), counter-clockwise.
  HalfedgeId rotate(HalfedgeId h) const { return opposite_[prev(h)]; }
  /// An outgoing half-edge of a live vertex; kNoHalfedge if the vertex has no triangle.
  HalfedgeId outgoing(VertexId v) const { return outgoing_[v]; }
  /// Edges at v, those to infinity included.
  std::uint32_t valence(VertexId v) const { return valence_[v]; }

  /// Removes the triangles of an edge or of a triangle with its neighbours and joins the corners in
  /// one vertex, which stays alive under the id \p kept.
  ///
  /// \param spokes  outgoing half-edges of the corners in the triangles that stay
  /// (Stencil::spokes). \param dying   for each pair of neighbours that dies the half-edge towards
  /// the core:
  ///                one for each side of the triangle, or the two sides of the edge.
  /// \pre the stencil is complete (hierarchy/mesh/stencil.h).
  void collapse(std::span<const HalfedgeId> spokes, std::span<const HalfedgeId> dying,
                VertexId kept);

  /// Replaces an edge by the other diagonal of its two triangles, which runs from apex(opposite(h))
  /// to apex(h) and keeps the id h.
  /// \pre neither triangle is a ghost, and the two apexes are not joined already.
  void flip(HalfedgeId h);

  /// Lets go of dead triangles and vertices, and numbers the others anew in the order they had, so
  /// that neighbours lie close in memory again. Walks about a vertex begin where they did.
  Survivors compact();

  /// Live triangles without ghosts, in memory order.
  std::vector<Corners> triangles() const;

 private:
  static HalfedgeId offset(HalfedgeId h, int by) {
    return HalfedgeId{static_cast<std::uint32_t>(h) + static_cast<std::uint32_t>(by)};
  }
  void pair_edges(std::span<const Corners> triangles);
  void split_fans();
  void claim_fan(HalfedgeId first, std::vector<bool>& claimed);
  void close_boundaries();
  void close_loop(HalfedgeId first);
  HalfedgeId next_boundary(HalfedgeId h) const;
  void count_valences();
  void kill(TriangleId t);

  std::uint32_t vertex_count_;
  std::uint32_t live_triangles_ = 0;
  IdVector<HalfedgeId, VertexId> start_;
  IdVector<HalfedgeId, HalfedgeId> opposite_;
  IdVector<TriangleId, std::uint8_t> live_;
  IdVector<VertexId, HalfedgeId> outgoing_;
  IdVector<VertexId, std::uint32_t> valence_;
  IdVector<VertexId, std::uint32_t> origin_;
  std::vector<bool> split_;
};

}  // namespace terrane::hierarchy

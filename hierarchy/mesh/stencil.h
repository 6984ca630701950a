#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "hierarchy/mesh/halfedge_mesh.h"

namespace terrane::hierarchy {

/// Why a triangle or an edge may not collapse, or kYes. Counted in reports.
enum class Collapsibility : std::uint8_t {
  kYes,
  kCyclic,         ///< a corner has valence 3, or the boundary polygon meets itself
  kValence,        ///< a neighbour's apex would drop to valence 3 or less
  kBoundary,       ///< type 4, or a rule of the lines forbids it
  kNotStarShaped,  ///< the boundary polygon does not see the new place
  kOverTolerance,  ///< a sample would be too far away
  kMorph,          ///< the blend from the finer level would fold or leave the tolerance
};
inline constexpr int kCollapsibilityCount = 7;

/// The surroundings of an edge or a triangle (the *core*) that a collapse replaces by a star.
///
/// \par Source
/// Gieng et al. 1998, section 3.1 (stencil, boundary polygon).
struct Stencil {
  std::vector<VertexId> polygon;      ///< boundary polygon, counter-clockwise
  std::vector<HalfedgeId> spokes;     ///< from the core into the triangles that stay
  std::array<HalfedgeId, 3> dying{};  ///< see HalfedgeMesh::collapse
  std::array<VertexId, 3> core{};
  std::uint32_t core_size = 0;  ///< 1: a vertex, 2: an edge, 3: a triangle

  /// Nothing dies about a vertex.
  std::span<const HalfedgeId> dying_span() const {
    return {dying.data(), core_size > 1 ? core_size : 0};
  }
  std::span<const VertexId> core_span() const { return {core.data(), core_size}; }
};

/// May a triangle with a corner of valence 3 collapse: one at a corner of the border (type 3 of P1,
/// section 4.4), or one of the three of a cycle? Its stencil is complete without the cycle.
enum class CornerTriangles : std::uint8_t { kStay, kMayCollapse };

/// Walks stencils; keeps the scratch space, so that a walk does not allocate.
class StencilWalker {
 public:
  explicit StencilWalker(const HalfedgeMesh& mesh,
                         CornerTriangles corner_triangles = CornerTriangles::kStay);

  /// Fills \p stencil with the surroundings of a live triangle that is no ghost.
  /// \return kYes if it is complete: connected, acyclic, its polygon simple and without a corner of
  ///         the triangle; and no neighbour's apex has valence 4.
  Collapsibility around_triangle(TriangleId triangle, Stencil& stencil);

  /// The same for an edge, as the special case of a triangle with two corners in one.
  /// \pre neither end of the edge is a ghost.
  Collapsibility around_edge(HalfedgeId edge, Stencil& stencil);

  /// The triangles of a vertex: a stencil for moving it.
  /// \pre the vertex is live and not on the boundary.
  void around_vertex(VertexId vertex, Stencil& stencil) const;

 private:
  void walk(HalfedgeId from_dying, HalfedgeId to_dying, Stencil& stencil) const;
  bool is_simple(const Stencil& stencil);
  bool leaves_enough_edges(const Stencil& stencil) const;

  const HalfedgeMesh& mesh_;
  CornerTriangles corner_triangles_;
  std::vector<std::uint32_t> seen_;
  std::uint32_t stamp_ = 0;
};

}  // namespace terrane::hierarchy

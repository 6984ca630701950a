#include "hierarchy/mesh/stencil.h"

#include <algorithm>
#include <utility>

namespace terrane::hierarchy {
namespace {

// a drop from 4 to 3 makes a cycle (P1, section 3.2); allowing it gave no fewer triangles
constexpr std::uint32_t kSmallestApexValence = 5;

// an edge collapse may leave valence 3: the star of such a vertex is a plain subdivided triangle,
// and refusing it cost 1 to 2 % more triangles on terrain (docs/benchmarks.md)
constexpr std::uint32_t kSmallestApexValenceOfEdge = 4;

}  // namespace

StencilWalker::StencilWalker(const HalfedgeMesh& mesh, CornerTriangles corner_triangles)
    : mesh_(mesh), corner_triangles_(corner_triangles) {}

Collapsibility StencilWalker::around_triangle(TriangleId triangle, Stencil& stencil) {
  stencil.polygon.clear();
  stencil.spokes.clear();
  stencil.core_size = 3;
  bool has_corner = false;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const HalfedgeId side = HalfedgeMesh::halfedge(triangle, k);
    stencil.dying[k] = mesh_.opposite(side);
    stencil.core[k] = mesh_.start(side);
    if (mesh_.valence(stencil.core[k]) <= 3) has_corner = true;
  }
  if (has_corner) {
    if (corner_triangles_ == CornerTriangles::kStay) return Collapsibility::kCyclic;
    if (!leaves_enough_edges(stencil)) return Collapsibility::kValence;
  }
  for (const HalfedgeId h : stencil.dying) {
    const VertexId apex = mesh_.apex(h);
    if (mesh_.valence(apex) < (mesh_.is_ghost(apex) ? 4U : kSmallestApexValence)) {
      return Collapsibility::kValence;
    }
  }
  for (std::uint32_t k = 0; k < 3; ++k) {
    walk(stencil.dying[k], HalfedgeMesh::next(stencil.dying[(k + 1) % 3]), stencil);
  }
  return is_simple(stencil) ? Collapsibility::kYes : Collapsibility::kCyclic;
}

Collapsibility StencilWalker::around_edge(HalfedgeId edge, Stencil& stencil) {
  const HalfedgeId back = mesh_.opposite(edge);
  stencil.polygon.clear();
  stencil.spokes.clear();
  stencil.core_size = 2;
  stencil.dying = {edge, back, kNoHalfedge};
  stencil.core = {mesh_.start(edge), mesh_.start(back), VertexId{}};
  for (const HalfedgeId h : stencil.dying_span()) {
    if (mesh_.valence(mesh_.apex(h)) < kSmallestApexValenceOfEdge) return Collapsibility::kValence;
  }
  walk(back, HalfedgeMesh::next(edge), stencil);
  walk(edge, HalfedgeMesh::next(back), stencil);
  return stencil.polygon.size() >= 3 && is_simple(stencil) ? Collapsibility::kYes
                                                           : Collapsibility::kCyclic;
}

void StencilWalker::around_vertex(VertexId vertex, Stencil& stencil) const {
  stencil.polygon.clear();
  stencil.spokes.clear();
  stencil.core_size = 1;
  stencil.core = {vertex, VertexId{}, VertexId{}};
  const HalfedgeId first = mesh_.outgoing(vertex);
  HalfedgeId spoke = first;
  do {
    stencil.spokes.push_back(spoke);
    stencil.polygon.push_back(mesh_.end(spoke));
    spoke = mesh_.rotate(spoke);
  } while (spoke != first);
}

/// Counter-clockwise about start(from_dying), from one dying triangle to the other, which to_dying
/// is in.
void StencilWalker::walk(HalfedgeId from_dying, HalfedgeId to_dying, Stencil& stencil) const {
  HalfedgeId spoke = mesh_.rotate(from_dying);
  while (spoke != to_dying) {
    stencil.spokes.push_back(spoke);
    stencil.polygon.push_back(mesh_.end(spoke));
    spoke = mesh_.rotate(spoke);
  }
}

/// Two sides of a triangle at a corner of valence 3 have one apex, which loses two edges.
bool StencilWalker::leaves_enough_edges(const Stencil& stencil) const {
  return std::ranges::all_of(stencil.dying, [&](HalfedgeId h) {
    const VertexId apex = mesh_.apex(h);
    const auto lost = std::ranges::count(stencil.dying, apex,
                                         [&](HalfedgeId other) { return mesh_.apex(other); });
    const std::uint32_t smallest = (mesh_.is_ghost(apex) ? 4U : kSmallestApexValence) - 1;
    return mesh_.valence(apex) >= smallest + static_cast<std::uint32_t>(lost);
  });
}

bool StencilWalker::is_simple(const Stencil& stencil) {
  seen_.resize(mesh_.vertex_count(), 0);
  ++stamp_;
  int ghosts = 0;
  const auto is_first_visit = [&](VertexId v) {
    if (mesh_.is_ghost(v)) return ++ghosts == 1;  // twice, or two loops: type 4 of P1
    return std::exchange(seen_[index(v)], stamp_) != stamp_;
  };
  return std::ranges::all_of(stencil.core_span(), is_first_visit) &&
         std::ranges::all_of(stencil.polygon, is_first_visit);
}

}  // namespace terrane::hierarchy

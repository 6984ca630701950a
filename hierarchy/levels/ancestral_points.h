#pragma once

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "hierarchy/mesh/ids.h"

namespace terrane::hierarchy {

/// Which vertices of M_0 went into each vertex of the current mesh.
///
/// The ancestral points of a triangle are those of its three corners: a collapse gives each
/// triangle of the new star the points of the collapsed one, which are those of the new vertex, and
/// leaves it the points of its two other corners. So the sets that the paper keeps per triangle
/// need only be kept per vertex, where they are disjoint and join without a search.
///
/// \par Source
/// Gieng et al. 1998, section 6 (figure 21).
class AncestralPoints {
 public:
  /// At M_0 every vertex is its own and only ancestral point.
  explicit AncestralPoints(std::size_t vertex_count)
      : next_(vertex_count), count_(vertex_count, 1) {
    std::iota(next_.begin(), next_.end(), 0U);
  }

  /// Gives those of \p gone to \p kept. \pre the two are different vertices.
  void join(VertexId kept, VertexId gone) {
    // two rings become one when any two of their links change places
    std::swap(next_[index(kept)], next_[index(gone)]);
    count_[index(kept)] += count_[index(gone)];
  }

  std::uint32_t count(VertexId v) const { return count_[index(v)]; }

  /// Calls visit(vertex of M_0) for each; v first.
  template <class Visit>
  void for_each(VertexId v, Visit visit) const {
    const auto first = static_cast<std::uint32_t>(v);
    std::uint32_t at = first;
    do {
      visit(at);
      at = next_[at];
    } while (at != first);
  }

 private:
  std::vector<std::uint32_t> next_;  // the vertices of M_0 that share a vertex, as a ring
  std::vector<std::uint32_t> count_;
};

}  // namespace terrane::hierarchy

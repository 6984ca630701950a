#pragma once

#include <Eigen/Core>
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
  explicit AncestralPoints(std::vector<Eigen::Vector3i> points)
      : points_(std::move(points)), next_(points_.size()), first_(points_.size()) {
    std::iota(next_.begin(), next_.end(), 0U);
    std::iota(first_.begin(), first_.end(), 0U);
  }

  /// Gives those of \p gone to \p kept. \pre the two are different vertices.
  void join(VertexId kept, VertexId gone) {
    // two rings become one when any two of their links change places
    std::swap(next_[first_[index(kept)]], next_[first_[index(gone)]]);
  }

  /// Calls visit(point of M_0) for each; that of v itself first.
  template <class Visit>
  void for_each(VertexId v, Visit visit) const {
    const std::uint32_t first = first_[index(v)];
    std::uint32_t at = first;
    do {
      visit(points_[at]);
      at = next_[at];
    } while (at != first);
  }

  /// Follows HalfedgeMesh::compact(), and lays the points of each vertex side by side, in the order
  /// in which they are visited.
  void compact(const std::vector<VertexId>& survivors) {
    std::vector<Eigen::Vector3i> points;
    std::vector<std::uint32_t> next;
    points.reserve(points_.size());
    next.reserve(points_.size());
    keep_only(first_, survivors);
    for (std::uint32_t v = 0; v < first_.size(); ++v) {
      const auto first = static_cast<std::uint32_t>(points.size());
      for_each(VertexId{v}, [&](const Eigen::Vector3i& point) {
        points.push_back(point);
        next.push_back(static_cast<std::uint32_t>(points.size()));
      });
      next.back() = first;
      first_[v] = first;
    }
    points_ = std::move(points);
    next_ = std::move(next);
  }

 private:
  std::vector<Eigen::Vector3i> points_;
  std::vector<std::uint32_t> next_;   // the points of M_0 that share a vertex, as a ring
  std::vector<std::uint32_t> first_;  // of each vertex: its own place in its ring
};

}  // namespace terrane::hierarchy

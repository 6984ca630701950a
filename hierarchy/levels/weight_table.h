#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "hierarchy/levels/collapse_judge.h"

namespace terrane::hierarchy {

/// What is known of the weight of each triangle of the current mesh: a lower bound, cheap to find,
/// or the weight itself, for which a surface is fitted and, with the error, a collapse planned.
///
/// Also remembers which triangles were found not to be collapsible, and why, until something about
/// them changes. Different triangles may be worked on at the same time.
/// \par Source
/// Gieng et al. 1998, section 6 (weights).
class WeightTable {
 public:
  /// \param level  must outlive the table. \param weights  too.
  WeightTable(const LevelMesh& level, const Weights& weights);

  /// Sets the key to what the weight cannot be below: curvature and error are never negative.
  void bound(TriangleId t);
  /// Finds the surface of a triangle, unless it is known.
  void fit(CollapseJudge& judge, TriangleId t);
  /// Curvatures are divided by the largest one of all surfaces fitted so far.
  void set_largest_curvature();
  /// Makes the key the weight. A triangle that may not collapse keeps its bound.
  void weigh(CollapseJudge& judge, TriangleId t);

  double key(TriangleId t) const { return keys_[index(t)]; }
  bool is_weighed(TriangleId t) const { return facts_[index(t)].state == State::kWeighed; }
  const LocalSurface& surface(TriangleId t) const { return facts_[index(t)].surface; }

  void begin_level(std::uint32_t number) { number_ = number; }
  void reject(TriangleId t, Rejection why);
  Rejection rejection(TriangleId t) const { return facts_[index(t)].rejection; }
  /// Rejected before, and nothing about its corners has changed since?
  bool is_rejected(TriangleId t, const std::array<VertexId, 3>& corners) const {
    const std::uint32_t at = facts_[index(t)].rejected_at;
    return at != 0 &&
           std::ranges::none_of(corners, [&](VertexId v) { return changed_at_[index(v)] >= at; });
  }
  /// Something about a vertex has changed at this level.
  void note_change(VertexId v) { changed_at_[index(v)] = number_; }

  /// Follows LevelMesh::compact().
  void compact(const Survivors& old);

 private:
  enum class State : std::uint8_t {
    kBounded,  ///< the key is a lower bound: nothing is known of the surface
    kFitted,   ///< a lower bound, but the surface is known
    kWeighed,  ///< the key is the weight
  };
  /// A cache line: what is asked together lies together.
  struct alignas(64) Facts {
    LocalSurface surface;
    double area = 0;
    std::uint32_t rejected_at = 0;  // level; 0: never
    State state = State::kBounded;
    Rejection rejection = Rejection::kOverlap;
  };

  const LevelMesh& level_;
  const Weights& weights_;
  double largest_curvature_ = 0;
  std::uint32_t number_ = 0;  // of the level under construction
  std::vector<double> keys_;  // apart from the rest: they are searched at every level
  std::vector<Facts> facts_;
  std::vector<std::uint32_t> changed_at_;  // level that last changed a vertex's surroundings
};

}  // namespace terrane::hierarchy

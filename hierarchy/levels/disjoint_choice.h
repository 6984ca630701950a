#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "hierarchy/levels/judge_pool.h"
#include "hierarchy/levels/weight_order.h"

namespace terrane::hierarchy {

/// A collapse that has been chosen; done when all of the level are.
struct Chosen {
  Entry entry;
  CollapsePlan plan;
};

/// Chooses triangles whose stencils do not meet, the lightest first.
///
/// The choice is that of a walk through the queue: a triangle is taken if its stencil meets none
/// that was taken before and it may collapse. But a triangle's turn has come as soon as it is the
/// lightest of all that wait about its stencil, whatever waits elsewhere. So the choice is made in
/// rounds, each through all that wait in memory order and on all threads, with the same outcome.
///
/// Guarantees: the outcome depends on keys and numbers alone, not on threads nor on how a queue is
/// dealt out to calls of choose().
/// \par Source
/// Gieng et al. 1998, section 5 (the queue); Blelloch, Fineman, Shun 2012, "Greedy sequential
/// maximal independent set and matching are parallel on average" (rounds).
class DisjointChoice {
 public:
  DisjointChoice(const LevelMesh& level, WeightTable& weights, JudgePool& judges);

  void begin_level();
  /// Chooses among triangles none of which is lighter than any of an earlier call at the level.
  ///
  /// \param waiting  weighed, unless taken or rejected; in memory order; used up.
  void choose(std::vector<Waiting>& waiting);
  /// Takes back the heaviest, to leave so many, and puts the others in memory order.
  void keep_lightest(std::size_t count);

  const std::vector<Chosen>& chosen() const { return chosen_; }
  /// How many triangles of those that were waiting were not taken, by reason; after
  /// keep_lightest(), how many that are lighter than the heaviest chosen one.
  std::array<std::uint32_t, kRejectionCount> rejected() const;
  /// For each vertex: is it in a stencil that was taken at this level?
  const std::vector<std::uint8_t>& taken() const { return taken_; }

  /// Follows LevelMesh::compact().
  void compact(const Survivors& old);

 private:
  enum class Verdict : std::uint8_t { kNotYet, kTaken, kRejected };
  /// The lightest of all that wait at each of its corners.
  struct Ripe {
    std::uint32_t place;  // in the list of those that wait
    Verdict verdict;
    CollapsePlan plan;
  };
  struct PassedOver {
    Entry entry;
    Rejection why;
  };

  /// Does the stencil of a triangle meet one that was taken at this level? All of that one's
  /// triangles touch its core, so a shared one joins a corner of t to it: that corner is in its
  /// core or on its polygon.
  bool is_taken(const std::array<VertexId, 3>& corners) const {
    return std::ranges::any_of(corners, [&](VertexId v) { return taken_[index(v)] != 0; });
  }
  void pass_over_rejected(std::vector<Waiting>& waiting);
  bool find_lightest(std::vector<Waiting>& waiting);
  void list_ripe(const std::vector<Waiting>& waiting);
  void judge_ripe(CollapseJudge& judge, const std::vector<Waiting>& waiting, Ripe& ripe);
  bool is_lightest_about(const Stencil& stencil, const Waiting& own,
                         const std::vector<Waiting>& waiting) const;
  bool spares_ghosts(const Stencil& stencil) const;
  void mark(const Stencil& stencil);
  void settle_ripe(std::vector<Waiting>& waiting);

  const LevelMesh& level_;
  WeightTable& weights_;
  JudgePool& judges_;
  std::vector<std::uint8_t> taken_;
  std::vector<std::uint32_t> lightest_;  // of a vertex: round_begin_ + place; less: none
  std::uint32_t round_begin_ = 1;
  std::vector<Ripe> ripe_;
  std::vector<Chosen> chosen_;
  std::vector<PassedOver> passed_over_;
};

}  // namespace terrane::hierarchy

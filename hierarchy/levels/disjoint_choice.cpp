#include "hierarchy/levels/disjoint_choice.h"

#include <algorithm>
#include <atomic>

namespace terrane::hierarchy {
namespace {

/// A vertex at infinity that loses an edge has to be left with four.
constexpr std::uint32_t kSmallestGhostValence = 5;
constexpr std::uint32_t kSettled = ~std::uint32_t{0};

}  // namespace

DisjointChoice::DisjointChoice(const LevelMesh& level, WeightTable& weights, JudgePool& judges)
    : level_(level),
      weights_(weights),
      judges_(judges),
      taken_(level.mesh.vertex_count(), 0),
      lightest_(level.mesh.vertex_count(), 0) {}

void DisjointChoice::compact(const Survivors& old) {
  taken_.resize(old.vertices.size());
  lightest_.resize(old.vertices.size());
}

void DisjointChoice::begin_level() {
  std::ranges::fill(taken_, 0);
  std::ranges::fill(lightest_, 0);
  round_begin_ = 1;
  chosen_.clear();
  passed_over_.clear();
}

void DisjointChoice::choose(std::vector<Waiting>& waiting) {
  pass_over_rejected(waiting);
  while (find_lightest(waiting)) {
    list_ripe(waiting);
    judges_.for_each_index(
        ripe_.size(),
        [&](CollapseJudge& judge, std::size_t i) { judge_ripe(judge, waiting, ripe_[i]); }, 64);
    settle_ripe(waiting);
  }
}

/// Those that are known not to be collapsible keep nobody waiting.
void DisjointChoice::pass_over_rejected(std::vector<Waiting>& waiting) {
  std::erase_if(waiting, [&](const Waiting& w) {
    const TriangleId t{w.triangle};
    if (is_taken(w.corners) || !weights_.is_rejected(t, w.corners)) return false;
    passed_over_.push_back({w, weights_.rejection(t)});
    return true;
  });
}

/// Drops what is settled and finds, for each vertex, the lightest triangle with that corner.
/// \return whether any is left.
bool DisjointChoice::find_lightest(std::vector<Waiting>& waiting) {
  std::uint32_t end = 0;
  for (const Waiting& w : waiting) {
    if (w.triangle == kSettled) continue;
    if (is_taken(w.corners)) {
      passed_over_.push_back({w, Rejection::kOverlap});
      continue;
    }
    waiting[end] = w;
    for (const VertexId v : w.corners) {
      std::uint32_t& lightest = lightest_[index(v)];
      // what is below round_begin_ is of an earlier round
      if (lightest < round_begin_ || w < waiting[lightest - round_begin_]) {
        lightest = round_begin_ + end;
      }
    }
    ++end;
  }
  waiting.resize(end);
  return end > 0;
}

void DisjointChoice::list_ripe(const std::vector<Waiting>& waiting) {
  ripe_.clear();
  for (std::uint32_t i = 0; i < waiting.size(); ++i) {
    const bool is_lightest = std::ranges::all_of(
        waiting[i].corners, [&](VertexId v) { return lightest_[index(v)] == round_begin_ + i; });
    if (is_lightest) ripe_.push_back(Ripe{i, Verdict::kNotYet, {Eigen::Vector3d::Zero()}});
  }
}

void DisjointChoice::judge_ripe(CollapseJudge& judge, const std::vector<Waiting>& waiting,
                                Ripe& ripe) {
  const Waiting& own = waiting[ripe.place];
  const TriangleId t{own.triangle};
  const auto reject = [&](Rejection why) {
    weights_.reject(t, why);
    ripe.verdict = Verdict::kRejected;
  };
  const auto frame = judge.frame(t);
  if (!frame) return reject(Rejection::kFlat);
  if (!judge.find_stencil(t)) return reject(judge.rejection());
  if (!is_lightest_about(judge.stencil(), own, waiting)) return;
  const auto plan = judge.place(*frame, weights_.surface(t));
  if (!plan) return reject(judge.rejection());
  if (!spares_ghosts(judge.stencil())) return reject(Rejection::kValence);
  ripe.verdict = Verdict::kTaken;
  ripe.plan = *plan;
  mark(judge.stencil());
}

bool DisjointChoice::is_lightest_about(const Stencil& stencil, const Waiting& own,
                                       const std::vector<Waiting>& waiting) const {
  return std::ranges::none_of(stencil.polygon, [&](VertexId v) {
    if (level_.mesh.is_ghost(v)) return false;
    const std::uint32_t lightest = lightest_[index(v)];
    return lightest >= round_begin_ && waiting[lightest - round_begin_] < own;
  });
}

bool DisjointChoice::spares_ghosts(const Stencil& stencil) const {
  return std::ranges::all_of(stencil.dying, [&](HalfedgeId h) {
    const VertexId apex = level_.mesh.apex(h);
    return !level_.mesh.is_ghost(apex) || level_.mesh.valence(apex) >= kSmallestGhostValence;
  });
}

void DisjointChoice::mark(const Stencil& stencil) {
  // two stencils that do not meet may have a vertex of their polygons in common
  const auto take = [&](VertexId v) {
    std::atomic_ref(taken_[index(v)]).store(1, std::memory_order_relaxed);
  };
  for (const VertexId v : stencil.core) take(v);
  for (const VertexId v : stencil.polygon) {
    if (!level_.mesh.is_ghost(v)) take(v);
  }
}

void DisjointChoice::settle_ripe(std::vector<Waiting>& waiting) {
  for (const Ripe& ripe : ripe_) {
    Waiting& own = waiting[ripe.place];
    if (ripe.verdict == Verdict::kNotYet) continue;
    if (ripe.verdict == Verdict::kTaken) {
      chosen_.push_back({own, ripe.plan});
    } else {
      passed_over_.push_back({own, weights_.rejection(TriangleId{own.triangle})});
    }
    own.triangle = kSettled;
  }
  round_begin_ += static_cast<std::uint32_t>(waiting.size());
}

void DisjointChoice::keep_lightest(std::size_t count) {
  if (chosen_.size() >= count) {
    const auto end = chosen_.begin() + static_cast<std::ptrdiff_t>(count);
    std::nth_element(chosen_.begin(), end - 1, chosen_.end(),
                     [](const Chosen& a, const Chosen& b) { return a.entry < b.entry; });
    chosen_.erase(end, chosen_.end());
    const Entry heaviest = chosen_.back().entry;
    std::erase_if(passed_over_, [&](const PassedOver& p) { return heaviest < p.entry; });
  }
  std::ranges::sort(chosen_, {}, [](const Chosen& c) { return c.entry.triangle; });
}

std::array<std::uint32_t, kRejectionCount> DisjointChoice::rejected() const {
  std::array<std::uint32_t, kRejectionCount> counts{};
  for (const PassedOver& p : passed_over_) ++counts[static_cast<std::size_t>(p.why)];
  return counts;
}

}  // namespace terrane::hierarchy

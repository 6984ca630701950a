#include "hierarchy/levels/build_levels.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "core/errors.h"
#include "hierarchy/levels/collapse_judge.h"
#include "hierarchy/levels/number_sequence.h"
#include "hierarchy/levels/triangle_weight.h"

namespace terrane::hierarchy {
namespace {

void check(const LevelOptions& options) {
  const Weights& w = options.weights;
  for (const double share : {w.curvature, w.angle, w.valence, w.error}) {
    if (!(share >= 0 && share <= 1)) {
      throw ConfigError(fmt::format("weight {}: has to lie between 0 and 1", share));
    }
  }
  if (!(options.share > 0 && options.share <= 1)) {
    throw ConfigError(fmt::format("--share {}: has to lie above 0 and not above 1", options.share));
  }
  if (options.jobs < 0) throw ConfigError(fmt::format("--jobs {}: is negative", options.jobs));
}

/// A triangle with its weight, or what it cannot be below, to be put in order.
struct Entry {
  double key;
  std::uint32_t triangle;

  bool operator<(const Entry& other) const {
    return key != other.key ? key < other.key : triangle < other.triangle;
  }
};

/// What comes next in the order, with what decides most of it at hand.
struct Waiting : Entry {
  std::array<VertexId, 3> corners;
};

/// A collapse that has been chosen; done when all of the level are.
struct Chosen {
  TriangleId triangle;
  CollapsePlan plan;
};

/// What a triangle would do, worked out before it is known whether it may.
struct Proposal {
  std::optional<CollapsePlan> plan;  ///< nothing: taken or rejected
  Stencil stencil;
};

/// Triangles planned at a time. A larger batch plans more in vain, for neighbours of those taken.
constexpr std::size_t kBatch = 1024;
/// Memory is moved together when less than this share of it is in use. At 0.5 and at 0.7 about the
/// same time; without, levels of 1.2 million triangles take 10 % longer.
constexpr double kFullest = 0.6;

class LevelBuilder {
 public:
  LevelBuilder(const SurfaceMesh& finest, const LevelOptions& options)
      : options_(options),
        level_(finest),
        judges_([this] { return CollapseJudge(level_, options_.rules); }),
        judge_(level_, options.rules),
        finest_vertex_count_(level_.mesh.vertex_count()),
        surfaces_(level_.mesh.triangle_count()),
        keys_(level_.mesh.triangle_count()),
        areas_(level_.mesh.triangle_count()),
        state_(level_.mesh.triangle_count(), State::kBounded),
        taken_(level_.mesh.vertex_count(), 0),
        rejected_at_(level_.mesh.triangle_count(), 0),
        rejected_for_(level_.mesh.triangle_count(), Rejection::kOverlap),
        changed_at_(level_.mesh.vertex_count(), 0),
        lost_edges_(level_.mesh.vertex_count(), 0) {}

  LevelSequence run() {
    begin();
    for (std::uint32_t i = 1; i <= options_.most_levels; ++i) {
      if (level_.mesh.live_triangle_count() <= options_.fewest_triangles) break;
      if (!build_level(i)) break;
    }
    LevelSequence sequence = number_sequence(level_, std::move(records_), finest_vertex_count_);
    if (is_last_unwanted_) drop_coarsest(sequence);
    return sequence;
  }

 private:
  enum class State : std::uint8_t {
    kBounded,  ///< the key is a lower bound: nothing is known of the surface
    kFitted,   ///< a lower bound, but the surface is known
    kKnown,    ///< the key is the weight
  };

  /// Fits all triangles, for the largest curvature, and bounds their weights.
  void begin() {
    const std::uint32_t count = level_.mesh.triangle_count();
    for_each_index(count, [&](CollapseJudge& judge, std::size_t i) {
      const TriangleId t{static_cast<std::uint32_t>(i)};
      if (level_.mesh.is_ghost(t)) return;
      bound(t);
      fit(judge, t);
    });
    for (std::uint32_t i = 0; i < count; ++i) {
      if (state_[i] == State::kFitted) {
        largest_curvature_ = std::max(largest_curvature_, surfaces_[i].absolute_curvature());
      }
    }
    list_candidates();
  }

  /// Calls work(judge, i) for i < count, on all threads, so many to a task.
  template <class Work>
  void for_each_index(std::size_t count, Work work, std::size_t grain = 256) {
    if (options_.jobs == 1) {
      for (std::size_t i = 0; i < count; ++i) work(judge_, i);
      return;
    }
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain), [&](const auto& range) {
      CollapseJudge& judge = judges_.local();
      for (std::size_t i = range.begin(); i < range.end(); ++i) work(judge, i);
    });
  }

  /// Sets the key to what the weight cannot be below: curvature and error are never negative.
  void bound(TriangleId t) {
    const HalfedgeId h = HalfedgeMesh::halfedge(t, 0);
    const VertexId a = level_.mesh.start(h), b = level_.mesh.end(h), c = level_.mesh.apex(h);
    const TriangleShape shape = shape_of(level_.point(a), level_.point(b), level_.point(c));
    const int valence =
        static_cast<int>(level_.mesh.valence(a) + level_.mesh.valence(b) + level_.mesh.valence(c)) -
        9;
    areas_[index(t)] = shape.area;
    keys_[index(t)] = shape.area * (options_.weights.angle * shape.angle +
                                    options_.weights.valence * valence_term(valence));
    state_[index(t)] = State::kBounded;
  }

  void fit(CollapseJudge& judge, TriangleId t) {
    if (state_[index(t)] != State::kBounded) return;
    const auto frame = judge.frame(t);
    surfaces_[index(t)] = frame ? judge.surface(t, *frame) : LocalSurface();
    state_[index(t)] = State::kFitted;
  }

  /// Works out the weight. A triangle that may not collapse keeps its bound.
  void weigh(CollapseJudge& judge, const Waiting& waiting) {
    const TriangleId t{waiting.triangle};
    if (state_[index(t)] == State::kKnown || is_taken(waiting.corners) ||
        is_known_to_be_rejected(waiting)) {
      return;
    }
    fit(judge, t);
    const LocalSurface& surface = surfaces_[index(t)];
    double terms = 0;
    if (largest_curvature_ > 0) {
      terms = options_.weights.curvature * surface.absolute_curvature() / largest_curvature_;
    }
    if (options_.weights.error > 0) {
      const auto frame = judge.frame(t);
      const auto plan = frame ? judge.plan(t, *frame, surface) : std::nullopt;
      if (!plan) {
        reject(t, frame ? judge.rejection() : Rejection::kFlat);
        return;
      }
      terms += options_.weights.error * judge.predictive_error(*frame, surface, *plan);
    }
    keys_[index(t)] += areas_[index(t)] * terms;
    state_[index(t)] = State::kKnown;
  }

  /// Does the stencil of a triangle meet one that was taken at this level? All of that one's
  /// triangles touch its core, so a shared one joins a corner of t to it: that corner is in its
  /// core or on its polygon.
  bool is_taken(const std::array<VertexId, 3>& corners) const {
    return std::ranges::any_of(corners, [&](VertexId v) { return taken_[index(v)] != 0; });
  }
  std::array<VertexId, 3> corners(TriangleId t) const {
    return {level_.mesh.start(HalfedgeMesh::halfedge(t, 0)),
            level_.mesh.start(HalfedgeMesh::halfedge(t, 1)),
            level_.mesh.start(HalfedgeMesh::halfedge(t, 2))};
  }

  void reject(TriangleId t, Rejection why) {
    rejected_at_[index(t)] = number_;
    rejected_for_[index(t)] = why;
  }

  /// Rejected before, and nothing about its corners has changed since?
  bool is_known_to_be_rejected(const Waiting& waiting) const {
    const std::uint32_t at = rejected_at_[waiting.triangle];
    return at != 0 && std::ranges::none_of(waiting.corners,
                                           [&](VertexId v) { return changed_at_[index(v)] >= at; });
  }

  /// Moves what is left of the mesh together once enough of it is gone: else every level would
  /// walk through all the memory of M_0. All orders stay, and so does the result.
  void compact() {
    if (level_.mesh.live_triangle_count() > kFullest * level_.mesh.triangle_count()) return;
    const Survivors old = level_.compact();
    keep_only(surfaces_, old.triangles);
    keep_only(keys_, old.triangles);
    keep_only(areas_, old.triangles);
    keep_only(state_, old.triangles);
    keep_only(rejected_at_, old.triangles);
    keep_only(rejected_for_, old.triangles);
    keep_only(taken_, old.vertices);
    keep_only(changed_at_, old.vertices);
    keep_only(lost_edges_, old.vertices);
    list_candidates();
  }

  void list_candidates() {
    candidates_.clear();
    for (std::uint32_t i = 0; i < level_.mesh.triangle_count(); ++i) {
      if (!level_.mesh.is_ghost(TriangleId{i})) candidates_.push_back(i);
    }
  }

  bool build_level(std::uint32_t number) {
    compact();
    number_ = number;
    statistics_ = {.level = number};
    choose();
    if (chosen_.empty()) return false;
    commit();
    statistics_.collapses = static_cast<std::uint32_t>(chosen_.size());
    statistics_.triangles = level_.mesh.live_triangle_count();
    is_last_unwanted_ = options_.keep && !options_.keep(statistics_);
    return !is_last_unwanted_;
  }

  /// Takes triangles in the order of their weights until the share is reached.
  void choose() {
    chosen_.clear();
    std::erase_if(candidates_, [&](auto i) { return !level_.mesh.is_live(TriangleId{i}); });
    rest_.clear();
    for (const std::uint32_t i : candidates_) rest_.push_back({keys_[i], i});
    const auto wanted = static_cast<std::size_t>(
        std::max(1.0, std::round(options_.share * static_cast<double>(rest_.size()))));
    while (chosen_.size() < wanted && !rest_.empty()) {
      next_portion(std::max<std::size_t>(64, 4 * wanted));
      take_from_portion(wanted);
    }
  }

  /// Moves the next triangles of the order, about so many, from rest_ to portion_: by weight, ties
  /// by number. All that is left in rest_ is heavier.
  void next_portion(std::size_t size) {
    const double heaviest = key_of_rank(size);
    portion_.clear();
    std::erase_if(rest_, [&](const Entry& entry) {
      if (entry.key > heaviest) return false;
      portion_.push_back({entry, {}});
      return true;
    });
    // still in memory order, so that neighbours are looked at one after the other
    for_each_index(portion_.size(), [&](CollapseJudge& judge, std::size_t i) {
      portion_[i].corners = corners(TriangleId{portion_[i].triangle});
      weigh(judge, portion_[i]);
      portion_[i].key = keys_[portion_[i].triangle];
    });
    // what turned out heavier may come after triangles that wait
    std::erase_if(portion_, [&](const Entry& entry) {
      if (entry.key <= heaviest) return false;
      rest_.push_back(entry);
      return true;
    });
    std::sort(portion_.begin(), portion_.end());
  }

  /// A key that about so many of rest_ do not exceed: by a sample, as any bound gives one order.
  double key_of_rank(std::size_t rank) {
    if (rank >= rest_.size()) return std::numeric_limits<double>::infinity();
    constexpr std::size_t kSampleSize = 4096;
    const std::size_t stride = std::max<std::size_t>(1, rest_.size() / kSampleSize);
    sample_.clear();
    for (std::size_t i = 0; i < rest_.size(); i += stride) sample_.push_back(rest_[i].key);
    const auto at = sample_.begin() + static_cast<std::ptrdiff_t>(rank / stride);
    if (at >= sample_.end()) return std::numeric_limits<double>::infinity();
    std::nth_element(sample_.begin(), at, sample_.end());
    return *at;
  }

  /// Plans collapses a batch ahead, on all threads: the mesh stays as it is until the commit, so a
  /// plan holds whatever else is taken. What is taken is then decided in order.
  void take_from_portion(std::size_t wanted) {
    for (std::size_t begin = 0; begin < portion_.size() && chosen_.size() < wanted;) {
      const std::size_t end = std::min(portion_.size(), begin + kBatch);
      for_each_index(
          end - begin,
          [&](CollapseJudge& judge, std::size_t i) {
            propose(judge, portion_[begin + i], proposals_[i]);
          },
          kBatch / 8);
      for (std::size_t i = 0; i < end - begin && chosen_.size() < wanted; ++i) {
        consider(portion_[begin + i], proposals_[i]);
      }
      begin = end;
    }
  }

  void propose(CollapseJudge& judge, const Waiting& waiting, Proposal& proposal) {
    proposal.plan.reset();
    if (is_taken(waiting.corners) || is_known_to_be_rejected(waiting)) return;
    const TriangleId t{waiting.triangle};
    const auto frame = judge.frame(t);
    if (frame) proposal.plan = judge.plan(t, *frame, surfaces_[index(t)]);
    if (proposal.plan) {
      proposal.stencil = judge.stencil();
    } else {
      reject(t, frame ? judge.rejection() : Rejection::kFlat);
    }
  }

  void consider(const Waiting& waiting, const Proposal& proposal) {
    if (is_taken(waiting.corners)) return count(Rejection::kOverlap);
    const TriangleId t{waiting.triangle};
    if (!proposal.plan) return count(rejected_for_[index(t)]);
    if (!apexes_can_spare_an_edge(proposal.stencil)) return count(Rejection::kValence);
    take(t, proposal);
  }

  void count(Rejection why) { ++statistics_.rejected[static_cast<std::size_t>(why)]; }

  /// Stencils that do not meet may still share an apex: it loses an edge to each.
  bool apexes_can_spare_an_edge(const Stencil& stencil) const {
    return std::ranges::all_of(stencil.dying, [&](HalfedgeId h) {
      const VertexId apex = level_.mesh.apex(h);
      if (level_.mesh.is_ghost(apex)) return level_.mesh.valence(apex) >= 5 + ghost_loss(apex);
      return lost_edges_[index(apex)] == 0 ||
             level_.mesh.valence(apex) >= 5U + lost_edges_[index(apex)];
    });
  }

  std::uint32_t ghost_loss(VertexId apex) const {
    const auto at = ghost_losses_.find(apex);
    return at == ghost_losses_.end() ? 0 : at->second;
  }

  void take(TriangleId t, const Proposal& proposal) {
    const Stencil& stencil = proposal.stencil;
    for (const VertexId v : stencil.core) taken_[index(v)] = 1;
    for (const VertexId v : stencil.polygon) {
      if (!level_.mesh.is_ghost(v)) taken_[index(v)] = 1;
    }
    for (const HalfedgeId h : stencil.dying) {
      const VertexId apex = level_.mesh.apex(h);
      if (level_.mesh.is_ghost(apex)) {
        ++ghost_losses_[apex];
      } else {
        ++lost_edges_[index(apex)];
      }
    }
    chosen_.push_back({t, *proposal.plan});
  }

  /// Collapses all that were chosen, then looks at the new stars.
  void commit() {
    records_.emplace_back();
    modified_.clear();
    StencilWalker walker(level_.mesh, CornerTriangles::kMayCollapse);
    // in memory order: stencils that do not meet may go in any
    std::ranges::sort(chosen_, {}, &Chosen::triangle);
    for (const Chosen& chosen : chosen_) collapse(walker, chosen);
    for_each_index(modified_.size(), [&](CollapseJudge&, std::size_t i) { bound(modified_[i]); });
    std::ranges::fill(taken_, 0);
    std::ranges::fill(lost_edges_, 0);
    ghost_losses_.clear();
  }

  void collapse(StencilWalker& walker, const Chosen& chosen) {
    walker.around_triangle(chosen.triangle, stencil_);
    Collapse record;
    bool is_on_border = false;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint32_t from = (chosen.plan.kept + k) % 3;
      const VertexId corner = stencil_.core[from];
      const VertexId apex = level_.mesh.apex(stencil_.dying[from]);
      record.corners[k] = level_.names[index(corner)];
      record.apexes[k] = level_.mesh.is_ghost(apex) ? kOutside : level_.names[index(apex)];
      record.before[k] = level_.points[index(corner)];
      is_on_border = is_on_border || level_.on_border[index(corner)];
    }
    record.after = level_.lattice.steps(chosen.plan.point);
    records_.back().push_back(record);

    const VertexId kept = stencil_.core[chosen.plan.kept];
    for (const VertexId v : stencil_.core) {
      if (v != kept) level_.ancestors.join(kept, v);
    }
    level_.mesh.collapse(stencil_.spokes, stencil_.dying_span(), kept);
    level_.points[index(kept)] = record.after;
    level_.on_border[index(kept)] = is_on_border;
    note_changes(kept);
  }

  void note_changes(VertexId kept) {
    changed_at_[index(kept)] = number_;
    for (const VertexId v : stencil_.polygon) {
      if (!level_.mesh.is_ghost(v)) changed_at_[index(v)] = number_;
    }
    for (const HalfedgeId h : stencil_.spokes) {
      const TriangleId t = HalfedgeMesh::triangle(h);
      if (!level_.mesh.is_ghost(t)) modified_.push_back(t);
    }
  }

  const LevelOptions& options_;
  LevelMesh level_;
  tbb::enumerable_thread_specific<CollapseJudge> judges_;
  CollapseJudge judge_;
  std::uint32_t finest_vertex_count_;

  std::vector<LocalSurface> surfaces_;
  std::vector<double> keys_;
  std::vector<double> areas_;
  std::vector<State> state_;
  double largest_curvature_ = 0;
  std::vector<std::uint32_t> candidates_;  // live triangles, by number
  std::vector<Waiting> portion_;           // of the order: what comes next,
  std::vector<Entry> rest_;                // and what comes later
  std::vector<double> sample_;
  std::vector<Proposal> proposals_{kBatch};

  std::uint32_t number_ = 0;                // of the level under construction
  std::vector<std::uint8_t> taken_;         // is the vertex in a stencil taken at this level?
  std::vector<std::uint32_t> rejected_at_;  // level, 0: never
  std::vector<Rejection> rejected_for_;
  std::vector<std::uint32_t> changed_at_;  // level that last changed a vertex's surroundings
  std::vector<std::uint8_t> lost_edges_;   // of a vertex, to the stencils taken at this level
  std::map<VertexId, std::uint32_t> ghost_losses_;

  std::vector<Chosen> chosen_;
  Stencil stencil_;
  std::vector<TriangleId> modified_;
  std::vector<std::vector<Collapse>> records_;
  LevelStatistics statistics_;
  bool is_last_unwanted_ = false;
};

}  // namespace

LevelSequence build_levels(const SurfaceMesh& finest, const LevelOptions& options) {
  check(options);
  if (finest.triangles.empty()) throw TopologyError("the mesh has no triangle");
  // TBB prints a warning where more threads are asked for than there are cores
  const int cores = tbb::info::default_concurrency();
  tbb::task_arena arena(options.jobs == 0 ? cores : std::min(options.jobs, cores));
  return arena.execute([&] { return LevelBuilder(finest, options).run(); });
}

}  // namespace terrane::hierarchy

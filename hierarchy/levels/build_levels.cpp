#include "hierarchy/levels/build_levels.h"

#include <fmt/format.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "hierarchy/levels/disjoint_choice.h"
#include "hierarchy/levels/judge_pool.h"
#include "hierarchy/levels/number_sequence.h"
#include "hierarchy/levels/weight_order.h"
#include "hierarchy/levels/weight_table.h"

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

/// Memory is moved together when less than this share of it is in use. At 0.5 and at 0.7 about the
/// same time; without, levels of 1.2 million triangles take 10 % longer.
constexpr double kFullest = 0.6;

class LevelBuilder {
 public:
  LevelBuilder(const SurfaceMesh& finest, const LevelOptions& options)
      : options_(options),
        level_(finest),
        finest_vertex_count_(level_.mesh.vertex_count()),
        judges_(level_, options.rules, options.jobs),
        weights_(level_, options.weights),
        order_(level_, weights_, judges_),
        choice_(level_, weights_, judges_) {}

  LevelSequence run() {
    weigh_finest();
    for (std::uint32_t i = 1; i <= options_.most_levels; ++i) {
      if (level_.mesh.live_triangle_count() <= options_.fewest_triangles) break;
      if (!build_level(i)) break;
    }
    LevelSequence sequence = number_sequence(level_, std::move(records_), finest_vertex_count_);
    if (is_last_unwanted_) drop_coarsest(sequence);
    return sequence;
  }

 private:
  /// Fits all triangles, for the largest curvature, and bounds their weights.
  void weigh_finest() {
    judges_.for_each_index(level_.mesh.triangle_count(), [&](CollapseJudge& judge, std::size_t i) {
      const TriangleId t{static_cast<std::uint32_t>(i)};
      if (level_.mesh.is_ghost(t)) return;
      weights_.bound(t);
      weights_.fit(judge, t);
    });
    weights_.set_largest_curvature();
  }

  bool build_level(std::uint32_t number) {
    compact();
    weights_.begin_level(number);
    choose();
    if (choice_.chosen().empty()) return false;
    commit();
    const LevelStatistics statistics{
        .level = number,
        .triangles = level_.mesh.live_triangle_count(),
        .collapses = static_cast<std::uint32_t>(choice_.chosen().size()),
        .rejected = choice_.rejected()};
    is_last_unwanted_ = options_.keep && !options_.keep(statistics);
    return !is_last_unwanted_;
  }

  /// Moves what is left of the mesh together once enough of it is gone: else every level would
  /// walk through all the memory of M_0. All orders stay, and so does the result.
  void compact() {
    if (level_.mesh.live_triangle_count() > kFullest * level_.mesh.triangle_count()) return;
    const Survivors old = level_.compact();
    weights_.compact(old);
    choice_.compact(old);
    order_.list_candidates();
  }

  /// Takes triangles in the order of their weights until the share is reached.
  void choose() {
    const std::size_t live = order_.begin_level();
    choice_.begin_level();
    const auto wanted = static_cast<std::size_t>(
        std::max(1.0, std::round(options_.share * static_cast<double>(live))));
    while (choice_.chosen().size() < wanted &&
           order_.next_portion(std::max<std::size_t>(64, 4 * wanted), choice_.taken())) {
      choose_from_portion(wanted);
    }
    choice_.keep_lightest(wanted);
  }

  void choose_from_portion(std::size_t wanted) {
    while (choice_.chosen().size() < wanted) {
      // one in four is taken, or fewer: a smaller slice judges fewer in vain
      auto& slice = order_.lightest_of_portion(4 * (wanted - choice_.chosen().size()));
      if (slice.empty()) return;
      choice_.choose(slice);
    }
  }

  /// Collapses all that were chosen, in memory order (stencils that do not meet may go in any),
  /// then looks at the new stars.
  void commit() {
    records_.emplace_back();
    modified_.clear();
    for (const Chosen& chosen : choice_.chosen()) collapse(chosen);
    judges_.for_each_index(modified_.size(),
                           [&](CollapseJudge&, std::size_t i) { weights_.bound(modified_[i]); });
  }

  void collapse(const Chosen& chosen) {
    walker_.around_triangle(TriangleId{chosen.entry.triangle}, stencil_);
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
    weights_.note_change(kept);
    for (const VertexId v : stencil_.polygon) {
      if (!level_.mesh.is_ghost(v)) weights_.note_change(v);
    }
    for (const HalfedgeId h : stencil_.spokes) {
      const TriangleId t = HalfedgeMesh::triangle(h);
      if (!level_.mesh.is_ghost(t)) modified_.push_back(t);
    }
  }

  const LevelOptions& options_;
  LevelMesh level_;
  std::uint32_t finest_vertex_count_;
  JudgePool judges_;
  WeightTable weights_;
  WeightOrder order_;
  DisjointChoice choice_;

  StencilWalker walker_{level_.mesh, CornerTriangles::kMayCollapse};
  Stencil stencil_;
  std::vector<TriangleId> modified_;
  std::vector<std::vector<Collapse>> records_;
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

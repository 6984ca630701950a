#include "hierarchy/collapse/strict_collapse.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "hierarchy/collapse/boundary_rule.h"
#include "hierarchy/collapse/edge_flip.h"
#include "hierarchy/collapse/morph_guard.h"
#include "hierarchy/collapse/near_locked.h"
#include "hierarchy/collapse/place_choice.h"
#include "hierarchy/collapse/polish_rounds.h"

namespace terrane::hierarchy {
namespace {

// a share that was best on St. Helens from 1 to 20 m (docs/benchmarks.md, Choices)
constexpr double kTriangleShare = 0.8;

// triangles in a row: with their samples they fit a second-level cache
constexpr std::uint32_t kBlock = 8192;

// that is how many edges from a locked vertex polish near it goes
constexpr int kNearEdges = 2;

// how far vertices try to go to each neighbour, round by round: 1/4, 1/2, 1/8, 1/16 of the way
constexpr std::int32_t kPartsOfWay[] = {4, 2, 8, 16};

// a sweep that collapses less than one in this many triangles is the last
constexpr std::int64_t kTooFew = 500;

class StrictCollapse {
 public:
  StrictCollapse(const TerrainMesh& input, const SampleField& field, const Placer& placer,
                 const FinerLevel& finer, const StrictOptions& options)
      : input_(input),
        mesh_(static_cast<std::uint32_t>(input.vertices.size()), input.triangles),
        vertices_(split_like(mesh_, input.vertices)),
        walker_(mesh_),
        placer_(placer),
        options_(options),
        sample_count_(field.is_reduced() && !field.is_backed()
                          ? 0
                          : static_cast<double>(field.sample_count())),
        samples_(field, vertices_, mesh_.triangles(), mesh_.triangle_count()),
        guard_(guard_of(finer, field)),
        choice_({mesh_, vertices_, samples_, field, placer, options.shape,
                 guard_ ? &*guard_ : nullptr}),
        changed_(vertices_.size(), 0),
        disturbed_(vertices_.size(), 0),
        tested_(mesh_.triangle_count() * 3, 0) {
    for (std::uint32_t v = 0; v < vertices_.size(); ++v) {
      if (mesh_.is_split(VertexId{v})) vertices_[v].kind = VertexKind::kLocked;
    }
    if (!input.lines.empty()) lines_.emplace(input.lines, vertices_.size(), options.lines);
    if (!guard_) {
      parent_.resize(vertices_.size());
      for (std::uint32_t v = 0; v < vertices_.size(); ++v) parent_[v] = VertexId{v};
      for (std::uint32_t v = 0; v < finer.target.size(); ++v)
        parent_[v] = VertexId{finer.target[v]};
    }
  }

  StrictResult run(std::size_t given_vertices) {
    // triangles leave slack for the edges, which come last; above level 0 the blend leaves enough
    const bool tries_more_places = guard_ && options_.effort > 0;
    const double share = guard_ ? 1 : kTriangleShare;
    choice_.set_search({share * options_.tolerance_m, tries_more_places});
    sweep([this](std::uint32_t triangle) { return sweep_triangle(TriangleId{triangle}); });
    choice_.set_search({options_.tolerance_m, tries_more_places});
    std::ranges::fill(tested_, 0);
    if (options_.effort > 0 || guard_) collapse_edges();
    if (options_.has_polish) polish();
    return finish(given_vertices);
  }

 private:
  template <class T>
  static std::vector<T> split_like(const HalfedgeMesh& mesh, const std::vector<T>& given) {
    std::vector<T> all(given);
    for (auto v = static_cast<std::uint32_t>(given.size()); v < mesh.vertex_count(); ++v) {
      all.push_back(given[mesh.origin(VertexId{v})]);
    }
    return all;
  }

  std::optional<MorphGuard> guard_of(const FinerLevel& finer, const SampleField& field) const {
    if (finer.places.empty()) return std::nullopt;
    MorphGuard guard(split_like(mesh_, finer.places), finer.triangles, vertices_, field, placer_,
                     options_.tolerance_m, options_.shape.smallest_altitude_cells);
    guard.begin_at(finer.target);
    return guard;
  }

  std::int64_t collapse_edges() {
    const std::int64_t before = result_.edge_collapses;
    sweep([this](std::uint32_t triangle) { return sweep_edges(TriangleId{triangle}); });
    return result_.edge_collapses - before;
  }

  /// Makes room under the tolerance and collapses what it then allows, again and again.
  void polish() {
    const auto [everywhere, near] =
        polish_rounds(options_.effort, guard_.has_value(),
                      sample_count_ / static_cast<double>(mesh_.live_triangle_count()));
    choice_.set_search({options_.tolerance_m, true});
    int idle_rounds = 0;
    for (int round = 0; round < everywhere + near; ++round) {
      if (idle_rounds == std::ssize(kPartsOfWay)) return;
      const bool is_everywhere = round < everywhere;
      if (!is_everywhere) is_polished_ = near_locked(mesh_, vertices_, kNearEdges);
      ++sweep_;
      flip_edges();
      for (std::uint32_t v = 0; v < mesh_.vertex_count(); ++v) {
        move(VertexId{v}, kPartsOfWay[round % std::ssize(kPartsOfWay)]);
      }
      flip_edges();
      if (is_everywhere) std::ranges::fill(tested_, 0);
      idle_rounds = collapse_edges() == 0 ? idle_rounds + 1 : 0;
    }
  }

  bool is_polished(VertexId v) const { return is_polished_.empty() || is_polished_[index(v)] != 0; }

  /// A finer level can blend into a mesh of other places, but not of other edges.
  void flip_edges() {
    if (guard_) return;
    for (std::uint32_t t = 0; t < mesh_.triangle_count(); ++t) flip_edges(TriangleId{t});
  }

  void flip_edges(TriangleId t) {
    if (!mesh_.is_live(t) || mesh_.is_ghost(t)) return;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const HalfedgeId h = HalfedgeMesh::halfedge(t, k);
      const TriangleId across = HalfedgeMesh::triangle(mesh_.opposite(h));
      if (!is_polished(mesh_.start(h)) || !is_polished(mesh_.end(h))) continue;
      if (across < t || !flip_.is_better(h, mesh_, vertices_, samples_, options_.tolerance_m,
                                         options_.shape, placer_)) {
        continue;
      }
      mesh_.flip(h);
      const TriangleId pair[] = {t, across};
      samples_.share_out(pair, flip_.samples(), flip_.keen_count(), flip_.sector());
      ++result_.flips;
    }
  }

  /// Moves a vertex towards a neighbour if it is nearer to the samples there.
  void move(VertexId v, std::int32_t parts_of_way) {
    if (!is_polished(v) || mesh_.outgoing(v) == kNoHalfedge) return;
    if (vertices_[index(v)].kind != VertexKind::kInterior) return;
    walker_.around_vertex(v, stencil_);
    const std::optional<Place> place = choice_.for_vertex(stencil_, v, parts_of_way);
    if (!place) return;
    choice_.hand_over(samples_);
    vertices_[index(v)].place = *place;
    ++result_.moves;
    changed_[index(v)] = sweep_;
    for (const VertexId w : stencil_.polygon) {
      if (!mesh_.is_ghost(w)) changed_[index(w)] = sweep_;
    }
  }

  /// Visits all triangles, block by block so that a block stays in the cache, until it is not worth
  /// another time. \p visit tells how many collapses it made.
  template <class Visit>
  void sweep(const Visit& visit) {
    std::int64_t done = 0;
    do {
      done = 0;
      for (std::uint32_t first = 0; first < mesh_.triangle_count(); first += kBlock) {
        done += sweep_block(first, std::min(first + kBlock, mesh_.triangle_count()), visit);
      }
    } while (done > mesh_.live_triangle_count() / kTooFew);
  }

  template <class Visit>
  std::int64_t sweep_block(std::uint32_t first, std::uint32_t end, const Visit& visit) {
    block_.resize(end - first);
    std::iota(block_.begin(), block_.end(), first);
    std::int64_t all = 0;
    for (;;) {
      ++sweep_;
      std::int64_t done = 0;
      std::size_t live = 0;
      for (const std::uint32_t t : block_) {
        if (!mesh_.is_live(TriangleId{t}) || mesh_.is_ghost(TriangleId{t})) continue;
        block_[live++] = t;
        done += visit(t);
      }
      block_.resize(live);
      all += done;
      if (done <= static_cast<std::int64_t>(live) / kTooFew) return all;
    }
  }

  std::int64_t sweep_triangle(TriangleId t) {
    const HalfedgeId h = HalfedgeMesh::halfedge(t, 0);
    const VertexId core[] = {mesh_.start(h), mesh_.end(h), mesh_.apex(h)};
    if (!is_due(tested_[index(t)], core)) return 0;
    return count(try_collapse(walker_.around_triangle(t, stencil_)), result_.triangle_collapses);
  }

  std::int64_t sweep_edges(TriangleId t) {
    std::int64_t done = 0;
    for (std::uint32_t k = 0; k < 3 && mesh_.is_live(t); ++k) {
      const HalfedgeId h = HalfedgeMesh::halfedge(t, k);
      const TriangleId across = HalfedgeMesh::triangle(mesh_.opposite(h));
      // each edge once, from the side with the smaller id; ghosts have the largest
      if (across < t) continue;
      const VertexId core[] = {mesh_.start(h), mesh_.end(h)};
      if (!is_due(tested_[index(h)], core)) continue;
      done += count(try_collapse(walker_.around_edge(h, stencil_)), result_.edge_collapses);
    }
    return done;
  }

  /// Not yet tried since its corners changed, and not next to a collapse of this sweep.
  bool is_due(std::uint32_t& tested, std::span<const VertexId> core) const {
    std::uint32_t newest_change = 0;
    for (const VertexId v : core) {
      if (disturbed_[index(v)] == sweep_) return false;
      newest_change = std::max(newest_change, changed_[index(v)]);
    }
    if (tested > newest_change) return false;
    tested = sweep_;
    return true;
  }

  std::int64_t count(Collapsibility verdict, std::int64_t& collapses) {
    ++result_.refusals[static_cast<std::size_t>(verdict)];
    if (verdict != Collapsibility::kYes) return 0;
    ++collapses;
    return 1;
  }

  Collapsibility try_collapse(Collapsibility complete) {
    if (complete != Collapsibility::kYes) return complete;
    const BoundaryVerdict boundary =
        classify(stencil_, mesh_, vertices_, placer_, lines_ ? &*lines_ : nullptr);
    if (boundary.type == BoundaryType::kFixed || is_water_meeting_land(boundary)) {
      return Collapsibility::kBoundary;
    }
    const auto best =
        boundary.onto ? choice_.onto_corner(stencil_, *boundary.onto) : choice_.for_core(stencil_);
    if (!best) return choice_.refusal();
    commit(*best, boundary.onto.value_or(stencil_.core[0]));
    return Collapsibility::kYes;
  }

  /// Where the shore is lost, at the edge of the data, water must not be drawn up.
  bool is_water_meeting_land(const BoundaryVerdict& boundary) const {
    if (boundary.type != BoundaryType::kInterior) return false;
    const float water_m = vertices_[index(stencil_.core[0])].water_m;
    return std::ranges::any_of(stencil_.core_span(), [&](VertexId v) {
      const float other_m = vertices_[index(v)].water_m;
      return other_m != water_m && !(std::isnan(other_m) && std::isnan(water_m));
    });
  }

  void commit(const Place& place, VertexId kept) {
    if (guard_) {
      guard_->join(stencil_.core_span(), kept);
    } else {
      for (const VertexId v : stencil_.core_span()) parent_[index(v)] = kept;
    }
    if (lines_) move_along_line(kept);
    hand_over_samples();
    mesh_.collapse(stencil_.spokes, stencil_.dying_span(), kept);
    vertices_[index(kept)].place = place;
    changed_[index(kept)] = disturbed_[index(kept)] = sweep_;
    for (const VertexId v : stencil_.polygon) {
      if (mesh_.is_ghost(v)) continue;
      disturbed_[index(v)] = sweep_;
      // a collapse seldom helps those around it: to try them again is worth it at level 0 alone
      if (!guard_) changed_[index(v)] = sweep_;
    }
  }

  /// A corner beside the kept one that is on its line has gone along the line.
  void move_along_line(VertexId kept) {
    for (const VertexId v : stencil_.core_span()) {
      if (v != kept && lines_->joins(v, kept)) lines_->drop(v, kept, vertices_);
    }
  }

  void hand_over_samples() {
    for (const HalfedgeId h : stencil_.dying_span()) samples_.clear(HalfedgeMesh::triangle(h));
    if (stencil_.core_size == 3) {
      samples_.clear(HalfedgeMesh::triangle(mesh_.opposite(stencil_.dying[0])));
    }
    choice_.hand_over(samples_);
  }

  VertexId target_of(std::uint32_t v) {
    if (guard_) return guard_->target_of(v);
    VertexId root{v};
    while (parent_[index(root)] != root) root = parent_[index(root)];
    return parent_[v] = root;
  }

  StrictResult finish(std::size_t given_vertices) {
    constexpr std::uint32_t kUnused = ~std::uint32_t{0};
    std::vector<std::uint32_t> number(vertices_.size(), kUnused);
    result_.mesh.triangles = mesh_.triangles();
    for (const Corners& corners : result_.mesh.triangles) {
      for (const std::uint32_t v : corners) number[v] = 0;
    }
    for (std::uint32_t v = 0; v < vertices_.size(); ++v) {
      if (number[v] == kUnused) continue;
      number[v] = static_cast<std::uint32_t>(result_.mesh.vertices.size());
      result_.mesh.vertices.push_back(vertices_[v]);
    }
    for (Corners& corners : result_.mesh.triangles) {
      for (std::uint32_t& v : corners) v = number[v];
    }
    keep_water();
    if (lines_) result_.mesh.lines = lines_->edges();
    for (LineEdge& edge : result_.mesh.lines) {
      for (std::uint32_t& v : edge) v = number[v];
      std::ranges::sort(edge);
    }
    result_.target.resize(given_vertices);
    for (std::uint32_t v = 0; v < given_vertices; ++v) {
      result_.target[v] = number[index(target_of(v))];
    }
    return std::move(result_);
  }

  /// Shores stay edges and nothing goes across them, so a triangle that is left lies where it lay.
  void keep_water() {
    if (input_.in_water.empty()) return;
    for (std::uint32_t t = 0; t < input_.triangles.size(); ++t) {
      if (mesh_.is_live(TriangleId{t})) result_.mesh.in_water.push_back(input_.in_water[t]);
    }
  }

  const TerrainMesh& input_;
  HalfedgeMesh mesh_;
  std::vector<TerrainVertex> vertices_;
  StencilWalker walker_;
  const Placer& placer_;
  const StrictOptions& options_;
  // 0 where nothing is behind those kept: a tile is then tried several times, and polish would be
  // paid each time
  double sample_count_;
  CoveredSamples samples_;
  std::optional<MorphGuard> guard_;
  PlaceChoice choice_;
  std::optional<LineChains> lines_;
  std::vector<VertexId> parent_;  // level 0 only: where a vertex went, to be followed

  std::vector<std::uint8_t> is_polished_;  // of each vertex; empty: all are

  std::uint32_t sweep_ = 0;
  std::vector<std::uint32_t> changed_;    // sweep after which a vertex is worth another try
  std::vector<std::uint32_t> disturbed_;  // sweep that last changed the surroundings of a vertex
  std::vector<std::uint32_t> tested_;     // sweep that last tried a triangle, later a half-edge

  std::vector<std::uint32_t> block_;
  Stencil stencil_;
  EdgeFlip flip_;
  StrictResult result_;
};

}  // namespace

StrictResult collapse_strictly(const TerrainMesh& input, const SampleField& field,
                               const Placer& placer, const FinerLevel& finer,
                               const StrictOptions& options) {
  return StrictCollapse(input, field, placer, finer, options).run(input.vertices.size());
}

}  // namespace terrane::hierarchy

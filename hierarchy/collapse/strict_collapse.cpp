#include "hierarchy/collapse/strict_collapse.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "hierarchy/collapse/boundary_rule.h"
#include "hierarchy/collapse/edge_flip.h"
#include "hierarchy/collapse/morph_guard.h"
#include "hierarchy/collapse/near_locked.h"
#include "hierarchy/collapse/polish_rounds.h"
#include "hierarchy/collapse/star_error.h"
#include "hierarchy/collapse/star_fit.h"

namespace terrane::hierarchy {
namespace {

// shares that were best on St. Helens from 1 to 20 m (docs/benchmarks.md, Choices)
constexpr double kTriangleShare = 0.8;
constexpr float kIntervalMargin = 0.2F;

// triangles in a row: with their samples they fit a second-level cache
constexpr std::uint32_t kBlock = 8192;

// that is how many edges from a locked vertex polish near it goes
constexpr int kNearEdges = 2;

// how far vertices try to go to each neighbour, round by round: 1/4, 1/2, 1/8, 1/16 of the way
constexpr std::int32_t kPartsOfWay[] = {4, 2, 8, 16};

// how far from its middle a core looks for more places: 1/4 of the way to each neighbour
constexpr std::int32_t kPartsBesideMiddle = 4;

// samples that a place is held against one after the other, if it first was not
constexpr int kMostLearnt = 4;

// a sweep that collapses less than one in this many triangles is the last
constexpr std::int64_t kTooFew = 500;

/// 1 / \p parts of the way, rounded to the lattice.
GridPoint part_of_way(GridPoint from, GridPoint to, std::int32_t parts) {
  return {from.x + (to.x - from.x) / parts, from.y + (to.y - from.y) / parts};
}

/// A place worth trying for the new vertex.
struct Candidate {
  GridPoint plan;
  double height_m = 0;  ///< what to take where no sample decides
  StarHeights heights;
  bool is_rejected = false;
};

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
        sample_count_(field.kept.empty() ? static_cast<double>(field.heights_m.size()) : 0),
        smallest_altitude_cells_(static_cast<float>(options.shape.smallest_altitude_cells)),
        field_(field),
        samples_(field, vertices_, mesh_.triangles(), mesh_.triangle_count()),
        changed_(vertices_.size(), 0),
        disturbed_(vertices_.size(), 0),
        tested_(mesh_.triangle_count() * 3, 0) {
    for (std::uint32_t v = 0; v < vertices_.size(); ++v) {
      if (mesh_.is_split(VertexId{v})) vertices_[v].kind = VertexKind::kLocked;
    }
    if (!input.lines.empty()) lines_.emplace(input.lines, vertices_.size(), options.lines);
    if (!finer.places.empty()) {
      guard_.emplace(split_like(mesh_, finer.places), finer.triangles, vertices_, field, placer,
                     options.tolerance_m, options.shape.smallest_altitude_cells);
      guard_->begin_at(finer.target);
    } else {
      parent_.resize(vertices_.size());
      for (std::uint32_t v = 0; v < vertices_.size(); ++v) parent_[v] = VertexId{v};
      for (std::uint32_t v = 0; v < finer.target.size(); ++v)
        parent_[v] = VertexId{finer.target[v]};
    }
  }

  StrictResult run(std::size_t given_vertices) {
    // triangles leave slack for the edges, which come last; above level 0 the blend leaves enough
    tolerance_m_ = (guard_ ? 1 : kTriangleShare) * options_.tolerance_m;
    tries_more_places_ = guard_ && options_.effort > 0;
    sweep([this](std::uint32_t triangle) { return sweep_triangle(TriangleId{triangle}); });
    tolerance_m_ = options_.tolerance_m;
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
    tries_more_places_ = true;
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
      if (across < t ||
          !flip_.is_better(h, mesh_, vertices_, samples_, tolerance_m_, options_.shape, placer_)) {
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
    gather_few();
    const Place here = vertices_[index(v)].place;
    here_ = &here;
    water_m_ = vertices_[index(v)].water_m;
    candidates_.clear();
    candidates_.push_back({here.plan, here.height_m});
    for (const VertexId to : stencil_.polygon) {
      const GridPoint there = vertices_[index(to)].place.plan;
      candidates_.push_back({part_of_way(here.plan, there, parts_of_way), here.height_m});
    }
    const std::optional<Place> place = best_candidate();
    here_ = nullptr;
    if (!place || place->lattice == here.lattice) return;
    samples_.share_out(star_.triangles(), star_.samples(), star_.keen_count(),
                       judge_.sectors(star_));
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
    const auto best = best_place(boundary);
    if (!best) return refusal_;
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

  void list_candidates() {
    candidates_.clear();
    std::int64_t x = 0, y = 0;
    double height_m = 0;
    for (const VertexId v : stencil_.core_span()) {
      const Place& place = vertices_[index(v)].place;
      x += place.plan.x;
      y += place.plan.y;
      height_m += place.height_m;
      candidates_.push_back({place.plan, place.height_m});
    }
    const std::int64_t n = stencil_.core_size;
    candidates_.push_back({{static_cast<std::int32_t>(x / n), static_cast<std::int32_t>(y / n)},
                           height_m / static_cast<double>(n)});
    if (tries_more_places_) list_more_candidates(candidates_.back());
  }

  /// Halfway from the middle to two corners, and places around it.
  void list_more_candidates(Candidate middle) {
    for (std::size_t end = 0; end < 2; ++end) {
      const Candidate there = candidates_[end];
      candidates_.push_back(
          {part_of_way(middle.plan, there.plan, 2), (middle.height_m + there.height_m) / 2});
    }
    for (const VertexId to : stencil_.polygon) {
      const GridPoint there = vertices_[index(to)].place.plan;
      candidates_.push_back({part_of_way(middle.plan, there, kPartsBesideMiddle), middle.height_m});
    }
  }

  /// Where the core may go; refusal_ says why if nowhere.
  std::optional<Place> best_place(const BoundaryVerdict& boundary) {
    gather_few();
    refusal_ = Collapsibility::kNotStarShaped;
    if (boundary.onto) {
      star_.gather_rest(samples_);
      return onto_line(vertices_[index(*boundary.onto)].place);
    }

    water_m_ = vertices_[index(stencil_.core[0])].water_m;
    list_candidates();
    return best_candidate();
  }

  /// The place of the candidate with the least squared error among those that may be written; where
  /// there are keen samples, with the least at those.
  std::optional<Place> best_candidate() {
    if (star_.sample_count() > 0) {
      if (!fit_candidates()) return std::nullopt;
    }
    star_.gather_rest(samples_);
    const bool is_judged_by_keen = star_.keen_count() > 0;
    if (!is_judged_by_keen) fit_candidates();
    while (Candidate* best = least_squared_error()) {
      bool is_worth_it = !is_judged_by_keen || fit(*best);
      for (int times = 0; is_worth_it && times < kMostLearnt; ++times) {
        has_learnt_ = false;
        if (const std::optional<Place> place = written(*best)) return place;
        is_worth_it = has_learnt_ && fit(*best);
      }
      best->is_rejected = true;
    }
    return std::nullopt;
  }

  void gather_few() {
    star_.gather_few(stencil_, mesh_, vertices_, samples_);
    judge_.begin();
  }

  /// Rejects the candidates that no height keeps near the samples gathered so far.
  /// \return whether one is left.
  bool fit_candidates() {
    bool is_any_left = false;
    for (Candidate& candidate : candidates_) {
      if (!candidate.is_rejected) candidate.is_rejected = !fit(candidate);
      is_any_left = is_any_left || !candidate.is_rejected;
    }
    return is_any_left;
  }

  std::optional<Place> onto_line(const Place& place) {
    candidates_.assign(1, {place.plan, place.height_m});
    if (!fit(candidates_[0]) || !is_sound(place)) return std::nullopt;
    refusal_ = Collapsibility::kOverTolerance;
    if (!holds(place) || !blends(place)) return std::nullopt;
    return place;
  }

  /// Is the star around a place near all samples, those that the reference leaves out as well? The
  /// worst of these is learnt.
  bool holds(const Place& place) {
    if (!judge_.holds(star_, place, tolerance_m_)) return false;
    if (!field_.is_backed()) return true;
    CoveredSample worst;
    if (worst_under_star(star_, place, field_, worst) <= tolerance_m_) return true;
    star_.learn(worst);
    has_learnt_ = true;
    return false;
  }

  /// Can the finer level's vertices that are in the core go to this place?
  bool blends(const Place& place) {
    if (!guard_ || guard_->allows(stencil_.core_span(), place)) return true;
    refusal_ = Collapsibility::kMorph;
    return false;
  }

  bool fit(Candidate& candidate) {
    const StarVerdict verdict =
        judge_.fit(star_, star_.centre(candidate.plan), static_cast<float>(tolerance_m_),
                   smallest_altitude_cells_, candidate.heights,
                   static_cast<std::size_t>(&candidate - candidates_.data()));
    if (verdict != StarVerdict::kNotStarShaped) refusal_ = Collapsibility::kOverTolerance;
    return verdict == StarVerdict::kFeasible;
  }

  Candidate* least_squared_error() {
    Candidate* best = nullptr;
    for (Candidate& candidate : candidates_) {
      if (candidate.is_rejected) continue;
      if (best && candidate.heights.squared_error >= best->heights.squared_error) continue;
      best = &candidate;
    }
    return best;
  }

  /// The place that will be written for a candidate, if it holds what the wished place promised.
  std::optional<Place> written(const Candidate& candidate) {
    const double height_m = std::isnan(water_m_) ? wished_height_m(candidate)
                                                 : placer_.over_datum_m(candidate.plan, water_m_);
    const Place place = placer_.place(candidate.plan, height_m);
    // as the mesh is, it is all that it has to be
    if (here_ && place.lattice == here_->lattice) return place;
    if (!is_sound(place)) return std::nullopt;
    if (!holds(place) || !blends(place)) return std::nullopt;
    return place;
  }

  double wished_height_m(const Candidate& candidate) const {
    const auto& [lowest, highest, best, squared_error] = candidate.heights;
    if (!std::isfinite(highest - lowest)) return candidate.height_m;
    const float margin = kIntervalMargin * (highest - lowest);
    return star_.origin().height_m + std::clamp(best, lowest + margin, highest - margin);
  }

  /// Is no triangle of the star turned over, too thin or too steep?
  bool is_sound(const Place& place) const {
    for (std::size_t k = 0; k < star_.sector_count(); ++k) {
      if (!is_well_shaped(place, star_.corner(k), star_.corner(k + 1), options_.shape, placer_)) {
        return false;
      }
    }
    return true;
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
    samples_.share_out(star_.triangles(), star_.samples(), star_.keen_count(),
                       judge_.sectors(star_));
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
  // 0 where they are picked: a tile is then tried several times, and polish would be paid each time
  double sample_count_;
  float smallest_altitude_cells_;
  const SampleField& field_;
  CoveredSamples samples_;
  std::optional<MorphGuard> guard_;
  std::optional<LineChains> lines_;
  std::vector<VertexId> parent_;  // level 0 only: where a vertex went, to be followed

  std::vector<std::uint8_t> is_polished_;  // of each vertex; empty: all are

  const Place* here_ = nullptr;  // of the vertex that may move; null in a collapse
  double tolerance_m_ = 0;       // of this sweep
  bool tries_more_places_ = false;
  std::uint32_t sweep_ = 0;
  std::vector<std::uint32_t> changed_;    // sweep after which a vertex is worth another try
  std::vector<std::uint32_t> disturbed_;  // sweep that last changed the surroundings of a vertex
  std::vector<std::uint32_t> tested_;     // sweep that last tried a triangle, later a half-edge

  std::vector<std::uint32_t> block_;
  Stencil stencil_;
  std::vector<Candidate> candidates_;
  float water_m_ = 0;  // of what is being moved; NaN on land
  EdgeFlip flip_;
  Star star_;
  StarJudge judge_;
  bool has_learnt_ = false;  // a sample, since a place was to be written
  Collapsibility refusal_ = Collapsibility::kYes;
  StrictResult result_;
};

}  // namespace

StrictResult collapse_strictly(const TerrainMesh& input, const SampleField& field,
                               const Placer& placer, const FinerLevel& finer,
                               const StrictOptions& options) {
  return StrictCollapse(input, field, placer, finer, options).run(input.vertices.size());
}

}  // namespace terrane::hierarchy

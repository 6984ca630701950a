#include "hierarchy/collapse/strict_collapse.h"

#include <algorithm>
#include <cmath>

#include "hierarchy/collapse/boundary_rule.h"
#include "hierarchy/collapse/morph_guard.h"
#include "hierarchy/collapse/star_fit.h"

namespace terrane::hierarchy {
namespace {

FieldPoint field_point(const Place& place) {
  return {column_of(place.plan), row_of(place.plan), place.height_m};
}

double squared_length(GridPoint a, GridPoint b) {
  const double x = static_cast<double>(b.x) - a.x, y = static_cast<double>(b.y) - a.y;
  return x * x + y * y;
}

/// A place worth trying for the new vertex.
struct Candidate {
  GridPoint plan;
  double height_m = 0;  ///< to keep, if is_fixed; else what to take where no sample decides
  bool is_fixed = false;
};

class StrictCollapse {
 public:
  StrictCollapse(const TerrainMesh& input, const SampleField& field, const Placer& placer,
                 const std::vector<Place>& finer, const StrictOptions& options)
      : mesh_(static_cast<std::uint32_t>(input.vertices.size()), input.triangles),
        vertices_(split_like(mesh_, input.vertices)),
        walker_(mesh_),
        field_(field),
        placer_(placer),
        options_(options),
        changed_(vertices_.size(), 0),
        tested_(mesh_.triangle_count() * 3, 0) {
    for (std::uint32_t v = 0; v < vertices_.size(); ++v) {
      if (mesh_.is_split(VertexId{v})) vertices_[v].kind = VertexKind::kLocked;
    }
    if (!finer.empty()) {
      guard_.emplace(split_like(mesh_, finer), mesh_.triangles(), vertices_, field,
                     options.tolerance_m);
    } else {
      parent_.resize(vertices_.size());
      for (std::uint32_t v = 0; v < vertices_.size(); ++v) parent_[v] = VertexId{v};
    }
  }

  StrictResult run(std::size_t given_vertices) {
    while (sweep_triangles() > worth_another_sweep()) {
    }
    while (sweep_edges() > worth_another_sweep()) {
    }
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

  std::int64_t worth_another_sweep() const { return mesh_.live_triangle_count() / 500; }

  std::int64_t sweep_triangles() {
    const std::int64_t before = result_.triangle_collapses;
    ++sweep_;
    for (std::uint32_t i = 0; i < mesh_.triangle_count(); ++i) {
      const TriangleId t{i};
      if (!mesh_.is_live(t) || mesh_.is_ghost(t)) continue;
      std::uint32_t newest = 0;
      for (std::uint32_t k = 0; k < 3; ++k) {
        newest = std::max(newest, changed_[index(mesh_.start(HalfedgeMesh::halfedge(t, k)))]);
      }
      if (!is_due(tested_[i], newest)) continue;
      result_.triangle_collapses += count(try_collapse(walker_.around_triangle(t, stencil_)));
    }
    return result_.triangle_collapses - before;
  }

  std::int64_t sweep_edges() {
    const std::int64_t before = result_.edge_collapses;
    if (!edges_begun_) std::ranges::fill(tested_, 0);
    edges_begun_ = true;
    ++sweep_;
    for (std::uint32_t i = 0; i < mesh_.triangle_count() * 3; ++i) {
      const HalfedgeId h{i};
      if (!mesh_.is_live(HalfedgeMesh::triangle(h))) continue;
      // each edge once, from the side with the smaller id
      if (index(mesh_.opposite(h)) < i) continue;
      if (mesh_.is_ghost(mesh_.start(h)) || mesh_.is_ghost(mesh_.end(h))) continue;
      const std::uint32_t newest =
          std::max(changed_[index(mesh_.start(h))], changed_[index(mesh_.end(h))]);
      if (!is_due(tested_[i], newest)) continue;
      result_.edge_collapses += count(try_collapse(walker_.around_edge(h, stencil_)));
    }
    return result_.edge_collapses - before;
  }

  /// Not yet tried since its corners changed, and not next to a collapse of this sweep.
  bool is_due(std::uint32_t& tested, std::uint32_t newest_change) const {
    if (newest_change == sweep_) return false;
    if (tested > newest_change) return false;
    tested = sweep_;
    return true;
  }

  std::int64_t count(Collapsibility verdict) {
    ++result_.refusals[static_cast<std::size_t>(verdict)];
    return verdict == Collapsibility::kYes ? 1 : 0;
  }

  Collapsibility try_collapse(Collapsibility complete) {
    if (complete != Collapsibility::kYes) return complete;
    const BoundaryVerdict boundary = classify(stencil_, mesh_, vertices_, placer_);
    if (boundary.type == BoundaryType::kFixed) return Collapsibility::kBoundary;
    list_candidates(boundary);
    list_sides();

    const auto best = best_place();
    if (!best) return refusal_;
    if (guard_ && !guard_->allows(stencil_.core_span(), *best)) return Collapsibility::kMorph;
    commit(*best, boundary.onto.value_or(stencil_.core[0]));
    return Collapsibility::kYes;
  }

  void list_candidates(const BoundaryVerdict& boundary) {
    candidates_.clear();
    if (boundary.onto) {
      const Place& place = vertices_[index(*boundary.onto)].place;
      candidates_.push_back({place.plan, place.height_m, true});
      return;
    }
    std::int64_t x = 0, y = 0;
    double height_m = 0;
    for (const VertexId v : stencil_.core_span()) {
      const Place& place = vertices_[index(v)].place;
      x += place.plan.x;
      y += place.plan.y;
      height_m += place.height_m;
      candidates_.push_back({place.plan, place.height_m, false});
    }
    const std::int64_t n = stencil_.core_size;
    candidates_.push_back({{static_cast<std::int32_t>(x / n), static_cast<std::int32_t>(y / n)},
                           height_m / static_cast<double>(n),
                           false});
  }

  void list_sides() {
    sides_.clear();
    plan_sides_.clear();
    const auto& polygon = stencil_.polygon;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const VertexId a = polygon[i], b = polygon[(i + 1) % polygon.size()];
      if (mesh_.is_ghost(a) || mesh_.is_ghost(b)) continue;
      const Place& from = vertices_[index(a)].place;
      const Place& to = vertices_[index(b)].place;
      sides_.push_back({field_point(from), field_point(to)});
      plan_sides_.push_back({from.plan, to.plan});
    }
  }

  /// The candidate with the least squared error; refusal_ says why if there is none.
  std::optional<Place> best_place() {
    std::optional<Place> best;
    double best_error = std::numeric_limits<double>::infinity();
    refusal_ = Collapsibility::kNotStarShaped;
    for (const Candidate& candidate : candidates_) {
      if (!is_star_shaped(candidate.plan)) continue;
      refusal_ = Collapsibility::kOverTolerance;
      const auto fit = fit_star(column_of(candidate.plan), row_of(candidate.plan), sides_, field_,
                                options_.tolerance_m, candidate.height_m);
      if (!fit || fit->squared_error_m2 >= best_error) continue;
      const std::optional<Place> place = written(candidate, *fit);
      if (!place) continue;
      best = place;
      best_error = fit->squared_error_m2;
    }
    return best;
  }

  /// The place that will be written for a candidate, if it holds what the wished place promised.
  std::optional<Place> written(const Candidate& candidate, const StarHeight& fit) const {
    if (candidate.is_fixed) {
      const Place& kept = *fixed_place(candidate.plan);
      return star_holds(kept) ? std::optional(kept) : std::nullopt;
    }
    const Place rounded = placer_.place(candidate.plan, fit.height_m);
    if (!is_star_shaped(rounded.plan) || !star_holds(rounded)) return std::nullopt;
    return rounded;
  }

  const Place* fixed_place(GridPoint plan) const {
    for (const VertexId v : stencil_.core_span()) {
      const TerrainVertex& vertex = vertices_[index(v)];
      if (vertex.kind != VertexKind::kInterior && vertex.place.plan == plan) return &vertex.place;
    }
    return nullptr;
  }

  bool star_holds(const Place& centre) const {
    const FieldPoint c = field_point(centre);
    return std::ranges::all_of(sides_, [&](const StarSide& side) {
      return is_within(c, side.from, side.to, field_, options_.tolerance_m);
    });
  }

  bool is_star_shaped(GridPoint centre) const {
    return std::ranges::all_of(plan_sides_, [&](const std::pair<GridPoint, GridPoint>& side) {
      const std::int64_t area = orient2d(centre, side.first, side.second);
      if (area <= 0) return false;
      // altitude = twice the area / longest side; squared, as roots took a quarter of all the time
      const double longest2 =
          std::max({squared_length(centre, side.first), squared_length(centre, side.second),
                    squared_length(side.first, side.second)});
      const double altitude = options_.smallest_altitude_cells * kUnitsPerCell;
      const auto twice_area = static_cast<double>(area);
      return twice_area * twice_area >= longest2 * altitude * altitude;
    });
  }

  void commit(const Place& place, VertexId kept) {
    if (guard_) {
      guard_->join(stencil_.core_span(), kept);
    } else {
      for (const VertexId v : stencil_.core_span()) parent_[index(v)] = kept;
    }
    mesh_.collapse(stencil_.spokes, stencil_.dying_span(), kept);
    vertices_[index(kept)].place = place;
    changed_[index(kept)] = sweep_;
    for (const VertexId v : stencil_.polygon) {
      if (!mesh_.is_ghost(v)) changed_[index(v)] = sweep_;
    }
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
    result_.target.resize(given_vertices);
    for (std::uint32_t v = 0; v < given_vertices; ++v) {
      result_.target[v] = number[index(target_of(v))];
    }
    return std::move(result_);
  }

  HalfedgeMesh mesh_;
  std::vector<TerrainVertex> vertices_;
  StencilWalker walker_;
  const SampleField& field_;
  const Placer& placer_;
  const StrictOptions& options_;
  std::optional<MorphGuard> guard_;
  std::vector<VertexId> parent_;  // level 0 only: where a vertex went, to be followed

  std::uint32_t sweep_ = 0;
  bool edges_begun_ = false;
  std::vector<std::uint32_t> changed_;  // sweep that last changed the surroundings of a vertex
  std::vector<std::uint32_t> tested_;   // sweep that last tried a triangle, later a half-edge

  Stencil stencil_;
  std::vector<Candidate> candidates_;
  std::vector<StarSide> sides_;
  std::vector<std::pair<GridPoint, GridPoint>> plan_sides_;
  Collapsibility refusal_ = Collapsibility::kYes;
  StrictResult result_;
};

}  // namespace

StrictResult collapse_strictly(const TerrainMesh& input, const SampleField& field,
                               const Placer& placer, const std::vector<Place>& finer,
                               const StrictOptions& options) {
  return StrictCollapse(input, field, placer, finer, options).run(input.vertices.size());
}

}  // namespace terrane::hierarchy

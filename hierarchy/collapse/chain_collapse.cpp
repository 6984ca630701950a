#include "hierarchy/collapse/chain_collapse.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <tuple>

#include "hierarchy/collapse/feasible_heights.h"
#include "hierarchy/collapse/morph_guard.h"
#include "hierarchy/collapse/triangle_shape.h"

namespace terrane::hierarchy {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

// two vertices become one at the samples nearest to the quarters of the way between them, too
constexpr int kPartsOfEdge = 4;

FieldPoint field_point(const Place& place) {
  return {column_of(place.plan), row_of(place.plan), place.height_m};
}

/// Largest vertical distance to the samples under a triangle; infinite if over the limit.
double worst_error_m(const FieldPoint& a, const FieldPoint& b, const FieldPoint& c,
                     const SampleField& field, double limit_m) {
  const double bx = b.column - a.column, by = b.row - a.row, bz = b.height_m - a.height_m;
  const double cx = c.column - a.column, cy = c.row - a.row, cz = c.height_m - a.height_m;
  const double scale = 1 / (bx * cy - by * cx);
  const double per_column = (bz * cy - by * cz) * scale, per_row = (bx * cz - bz * cx) * scale;
  double worst = 0;
  const bool is_within = for_each_sample(
      a, b, c, field, field.slack_cells, [&](std::size_t, const FieldSample& sample) {
        const double z =
            a.height_m + (sample.column - a.column) * per_column + (sample.row - a.row) * per_row;
        worst = std::max(worst, std::abs(z - sample.height_m));
        return worst <= limit_m;
      });
  return is_within ? worst : std::numeric_limits<double>::infinity();
}

/// The vertices around one of the chain's, counter-clockwise.
struct Ring {
  std::vector<std::uint32_t> vertices;  ///< empty if they are not one fan
  bool is_closed = false;               ///< else from the mesh's edge to its edge
};

Ring ring_of(std::vector<std::pair<std::uint32_t, std::uint32_t>> sides) {
  if (sides.empty()) return {};
  const auto leads_to = [&](std::uint32_t v) {
    return std::ranges::find(sides, v, &std::pair<std::uint32_t, std::uint32_t>::second);
  };
  auto first = std::ranges::find_if(
      sides, [&](const auto& side) { return leads_to(side.first) == sides.end(); });
  Ring ring{.is_closed = first == sides.end()};
  if (ring.is_closed) first = sides.begin();
  std::size_t used = 0;
  for (auto side = first; side != sides.end() && used < sides.size(); ++used) {
    ring.vertices.push_back(side->first);
    const std::uint32_t to = side->second;
    side = std::ranges::find(sides, to, &std::pair<std::uint32_t, std::uint32_t>::first);
    if (side == sides.end()) ring.vertices.push_back(to);
    if (side == first) {
      ++used;
      break;
    }
  }
  return used == sides.size() ? ring : Ring{};
}

/// A collapse that the error allows. The chain's vertices are named by their place in it.
struct Candidate {
  double worst_m;
  double altitude2;  // the new triangles' smallest, squared
  std::uint32_t gone, onto;
  std::uint32_t version, version_onto;  // of their surroundings
  Place place;                          // where onto is written then
  BorderPlace at;                       // the same, on the line
  double raised_m;                      // the height wished for it; NaN: as it is

  /// Is it to be done later?
  bool operator<(const Candidate& other) const {
    const auto along = [](const Candidate& c) { return c.at.column + c.at.row; };
    return std::tuple(other.worst_m, altitude2, other.gone, other.onto, along(other)) <
           std::tuple(worst_m, other.altitude2, gone, onto, along(*this));
  }
};

class ChainCollapse {
 public:
  ChainCollapse(const TerrainMesh& strip, std::span<const std::uint32_t> chain,
                const FinerLevel& finer, const SampleField& field, const Placer& placer,
                const ChainOptions& options)
      : vertices_(strip.vertices),
        chain_(chain),
        field_(field),
        placer_(placer),
        options_(options),
        place_in_chain_(strip.vertices.size(), kNone),
        before_(chain.size()),
        after_(chain.size()),
        version_(chain.size(), 0) {
    for (std::uint32_t i = 0; i < chain.size(); ++i) {
      place_in_chain_[chain[i]] = i;
      before_[i] = i == 0 ? kNone : i - 1;
      after_[i] = i + 1 == chain.size() ? kNone : i + 1;
    }
    gather_rings(strip.triangles);
    if (!finer.places.empty()) {
      guard_.emplace(finer.places, finer.triangles, vertices_, field, placer,
                     options.blend_tolerance_m, options.smallest_altitude_cells);
    }
    for (std::uint32_t v = 0; v < vertices_.size(); ++v) result_.target.push_back(v);
    result_.raised_m.resize(vertices_.size(), std::numeric_limits<double>::quiet_NaN());
  }

  ChainResult run() {
    for (std::uint32_t i = 0; i < chain_.size(); ++i) {
      for (const std::uint32_t onto : {before_[i], after_[i]}) enqueue(i, onto);
    }
    while (!queue_.empty()) {
      const Candidate next = queue_.top();
      queue_.pop();
      const bool is_fresh =
          next.version == version_[next.gone] && next.version_onto == version_[next.onto];
      if (is_fresh && blends(next)) collapse(next);
    }
    follow_targets();
    for (const TerrainVertex& vertex : vertices_) {
      result_.places.push_back(vertex.place);
      result_.borders.push_back(vertex.border);
    }
    return std::move(result_);
  }

 private:
  void gather_rings(const std::vector<Corners>& triangles) {
    std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> sides(chain_.size());
    for (const Corners& corners : triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t i = place_in_chain_[corners[k]];
        if (i != kNone) sides[i].emplace_back(corners[(k + 1) % 3], corners[(k + 2) % 3]);
      }
    }
    for (auto& of_vertex : sides) rings_.push_back(ring_of(std::move(of_vertex)));
  }

  const Place& place(std::uint32_t i) const { return vertices_[chain_[i]].place; }

  bool may_go(std::uint32_t i) const {
    if (vertices_[chain_[i]].kind == VertexKind::kLocked) return false;
    if (before_[i] == kNone || after_[i] == kNone) return false;
    const auto& [around, is_closed] = rings_[i];
    if (around.empty()) return false;
    const std::uint32_t a = chain_[before_[i]], b = chain_[after_[i]];
    if (is_closed) {
      return std::ranges::find(around, a) != around.end() &&
             std::ranges::find(around, b) != around.end();
    }
    return std::minmax(a, b) == std::minmax(around.front(), around.back());
  }

  /// May an edge stand for the samples between the neighbours of i?
  bool may_be_joined(std::uint32_t i) const {
    const Place &a = place(before_[i]), &b = place(after_[i]);
    return rings_[i].is_closed ? placer_.bend_m(a, b) <= options_.largest_bend_m
                               : placer_.is_straight(a, b);
  }

  /// May edges to a place between two neighbours stand for the samples on both sides of it?
  bool may_be_joined(std::uint32_t gone, std::uint32_t onto, const Place& between) const {
    const bool is_before = before_[gone] == onto;
    for (const std::uint32_t end :
         {is_before ? after_[gone] : before_[gone], is_before ? before_[onto] : after_[onto]}) {
      if (placer_.bend_m(between, place(end)) > options_.largest_bend_m) return false;
    }
    return true;
  }

  void enqueue(std::uint32_t gone, std::uint32_t onto) {
    if (!may_go(gone)) return;
    if (may_be_joined(gone)) enqueue(judge(gone, onto, vertices_[chain_[onto]].border));
    // between them it is all the same which one goes
    if (onto != after_[gone] || !may_be_raised(gone, onto)) return;
    for (const BorderPlace& at : between(gone, onto)) enqueue(judge(gone, onto, at));
  }

  void enqueue(const Candidate& candidate) {
    if (std::isfinite(candidate.worst_m)) queue_.push(candidate);
  }

  /// Samples of the line between two vertices of the chain.
  std::vector<BorderPlace> between(std::uint32_t gone, std::uint32_t onto) const {
    const BorderPlace a = vertices_[chain_[gone]].border, b = vertices_[chain_[onto]].border;
    std::vector<BorderPlace> places;
    if (!a.is_sample() || !b.is_sample()) return places;
    for (int k = 1; k < kPartsOfEdge; ++k) {
      const BorderPlace at(a.column + std::trunc((b.column - a.column) * k / kPartsOfEdge),
                           a.row + std::trunc((b.row - a.row) * k / kPartsOfEdge));
      if (at == a || at == b || (!places.empty() && places.back() == at)) continue;
      places.push_back(at);
    }
    return places;
  }

  /// The vertices around i from its neighbour `onto` on, that one left out.
  std::vector<std::uint32_t> others(std::uint32_t i, std::uint32_t onto) const {
    const auto& [around, is_closed] = rings_[i];
    std::vector<std::uint32_t> result;
    const auto at = std::ranges::find(around, chain_[onto]);
    result.assign(at + 1, around.end());
    result.insert(result.end(), around.begin(), at);
    return result;
  }

  /// May a vertex that another collapses onto go up or down with it? Not on the edge of the data.
  bool may_be_raised(std::uint32_t gone, std::uint32_t onto) const {
    return options_.place_at && may_go(onto) && rings_[gone].is_closed && rings_[onto].is_closed;
  }

  /// The fan around both; the last vertex is the first again.
  std::vector<std::uint32_t> around_both(std::uint32_t gone, std::uint32_t onto) const {
    std::vector<std::uint32_t> all = others(gone, onto), second = others(onto, gone);
    all.insert(all.end(), second.begin() + 1, second.end());
    return all;
  }

  /// The height that is best for the fan; none if there is none within the tolerance.
  std::optional<double> best_height_m(const Place& centre,
                                      const std::vector<std::uint32_t>& around) const {
    FeasibleHeights heights(field_, options_.tolerance_m);
    for (std::size_t k = 0; k + 1 < around.size(); ++k) {
      const Place &a = vertices_[around[k]].place, &b = vertices_[around[k + 1]].place;
      if (orient2d(centre.plan, a.plan, b.plan) <= 0) return std::nullopt;
      if (!heights.add(field_point(centre), field_point(a), field_point(b))) return std::nullopt;
    }
    return heights.best_m();
  }

  Candidate judge(std::uint32_t gone, std::uint32_t onto, const BorderPlace& at) const {
    constexpr double kRefused = std::numeric_limits<double>::infinity();
    Candidate candidate{0,
                        kRefused,
                        gone,
                        onto,
                        version_[gone],
                        version_[onto],
                        place(onto),
                        at,
                        std::numeric_limits<double>::quiet_NaN()};
    std::vector<std::uint32_t> around;
    if (may_be_raised(gone, onto)) {
      around = around_both(gone, onto);
      if (at != vertices_[chain_[onto]].border) {
        candidate.place = options_.place_at(at.sample(), place(onto).height_m);
        if (!may_be_joined(gone, onto, candidate.place)) {
          candidate.worst_m = kRefused;
          return candidate;
        }
      }
      const std::optional<double> height_m = best_height_m(candidate.place, around);
      if (!height_m) {
        candidate.worst_m = kRefused;
        return candidate;
      }
      candidate.raised_m = *height_m;
      candidate.place = options_.place_at(at.sample(), *height_m);
    } else {
      around = others(gone, onto);
    }
    const Place& centre = candidate.place;
    for (std::size_t k = 0; k + 1 < around.size(); ++k) {
      const Place &a = vertices_[around[k]].place, &b = vertices_[around[k + 1]].place;
      if (!is_upright(centre, a, b, options_.smallest_altitude_cells, placer_)) {
        candidate.worst_m = kRefused;
        return candidate;
      }
      candidate.altitude2 =
          std::min(candidate.altitude2, squared_altitude(centre.plan, a.plan, b.plan));
      candidate.worst_m =
          std::max(candidate.worst_m, worst_error_m(field_point(centre), field_point(a),
                                                    field_point(b), field_, options_.tolerance_m));
      if (candidate.worst_m == kRefused) return candidate;
    }
    return candidate;
  }

  bool blends(const Candidate& candidate) {
    if (!guard_) return true;
    const VertexId core[] = {VertexId{chain_[candidate.gone]}, VertexId{chain_[candidate.onto]}};
    const std::size_t moving = std::isnan(candidate.raised_m) ? 1 : 2;
    if (guard_->allows(std::span(core).first(moving), candidate.place)) return true;
    ++result_.refused_by_blend;
    return false;
  }

  void collapse(const Candidate& candidate) {
    const std::uint32_t gone = candidate.gone, onto = candidate.onto;
    const std::uint32_t u = chain_[gone], v = chain_[onto];
    vertices_[v].place = candidate.place;
    vertices_[v].border = candidate.at;
    if (!std::isnan(candidate.raised_m)) result_.raised_m[v] = candidate.raised_m;
    if (guard_) {
      const VertexId core[] = {VertexId{u}, VertexId{v}};
      guard_->join(core, VertexId{v});
    }
    hand_over_ring(gone, onto);
    const std::uint32_t other = before_[gone] == onto ? after_[gone] : before_[gone];
    (before_[gone] == onto ? after_[onto] : before_[onto]) = other;
    (before_[gone] == onto ? before_[other] : after_[other]) = onto;
    ++version_[gone];
    rings_[gone] = {};
    result_.target[u] = v;
    ++result_.collapses;
    enqueue_near(onto);
  }

  /// Tries again what is near a vertex whose surroundings changed: its neighbours' changed, too.
  void enqueue_near(std::uint32_t centre) {
    std::vector<std::uint32_t> changed{centre};
    for (const std::uint32_t i : {before_[centre], after_[centre]}) {
      if (i != kNone) changed.push_back(i);
    }
    for (const std::uint32_t i : changed) ++version_[i];
    for (const std::uint32_t i : changed) {
      for (const std::uint32_t n : {before_[i], after_[i]}) {
        if (n == kNone) continue;
        enqueue(i, n);
        const bool is_also_changed = std::ranges::find(changed, n) != changed.end();
        if (!is_also_changed) enqueue(n, i);
      }
    }
  }

  ///      a3───a2            onto's ring had ... a1, gone, a4 ...: a2 and a3 take gone's place;
  ///     /  \ /  \           the other neighbours see onto where gone was
  ///    x───gone──a1
  ///     \  / \  /
  ///      a4──onto
  void hand_over_ring(std::uint32_t gone, std::uint32_t onto) {
    const std::uint32_t u = chain_[gone], v = chain_[onto];
    std::vector<std::uint32_t> around = others(gone, onto);
    for (const std::uint32_t w : around) {
      const std::uint32_t i = place_in_chain_[w];
      if (i != kNone) std::ranges::replace(rings_[i].vertices, u, v);
    }
    const bool begins_with_v = rings_[gone].vertices.front() == v;
    if (rings_[gone].is_closed || !begins_with_v) around.pop_back();
    if (rings_[gone].is_closed || begins_with_v) around.erase(around.begin());
    auto& ring = rings_[onto].vertices;
    const auto at = std::ranges::find(ring, u);
    if (at == ring.end()) return;
    ring.insert(ring.erase(at), around.begin(), around.end());
  }

  void follow_targets() {
    for (const std::uint32_t v : chain_) {
      std::uint32_t& target = result_.target[v];
      while (result_.target[target] != target) target = result_.target[target];
    }
  }

  std::vector<TerrainVertex> vertices_;
  std::span<const std::uint32_t> chain_;
  const SampleField& field_;
  const Placer& placer_;
  const ChainOptions& options_;
  std::optional<MorphGuard> guard_;

  std::vector<std::uint32_t> place_in_chain_;  // of each vertex of the strip
  std::vector<std::uint32_t> before_, after_;  // neighbours in what is left of the chain
  std::vector<std::uint32_t> version_;
  std::vector<Ring> rings_;
  std::priority_queue<Candidate> queue_;
  ChainResult result_;
};

}  // namespace

ChainResult collapse_chain(const TerrainMesh& strip, std::span<const std::uint32_t> chain,
                           const FinerLevel& finer, const SampleField& field, const Placer& placer,
                           const ChainOptions& options) {
  return ChainCollapse(strip, chain, finer, field, placer, options).run();
}

}  // namespace terrane::hierarchy

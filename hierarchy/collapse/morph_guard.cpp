#include "hierarchy/collapse/morph_guard.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "hierarchy/collapse/within_task.h"

namespace terrane::hierarchy {
namespace {

// of the altitude that triangles have at either end: they may become thinner in between
constexpr double kShareOfAltitude = 0.25;

// with more samples than that under a triangle, all threads look at those that move
constexpr std::size_t kManySamples = 100;

using PlanVector = PlanPoint;
using PlanTriangle = std::array<PlanPoint, 3>;
using Passage = std::array<PlanPoint, 6>;  // corners before and after

PlanVector between(const PlanPoint& a, const PlanPoint& b) { return {b.x - a.x, b.y - a.y}; }

double cross(PlanVector a, PlanVector b) { return a.x * b.y - a.y * b.x; }

double longest(PlanVector u, PlanVector v) {
  return std::sqrt(std::max({u.x * u.x + u.y * u.y, v.x * v.x + v.y * v.y,
                             (u.x - v.x) * (u.x - v.x) + (u.y - v.y) * (u.y - v.y)}));
}

/// Does the triangle keep its orientation for all t in (0, 1) on its way from a to b, and with
/// room to spare in between? Twice its area is the quadratic q0 + q1 t + q2 t^2.
bool keeps_orientation(const PlanTriangle& a, const PlanTriangle& b, double least_altitude) {
  const PlanVector u0 = between(a[0], a[1]), v0 = between(a[0], a[2]);
  const PlanVector u1 = between(b[0], b[1]), v1 = between(b[0], b[2]);
  const PlanVector du{u1.x - u0.x, u1.y - u0.y}, dv{v1.x - v0.x, v1.y - v0.y};
  const double q0 = cross(u0, v0);
  const double q1 = cross(u0, dv) + cross(du, v0);
  const double q2 = cross(du, dv);
  const double at_end = cross(u1, v1);
  if (q0 <= 0 || at_end < 0) return false;
  const double least_area = least_altitude * std::max(longest(u0, v0), longest(u1, v1));
  if (at_end == 0) {
    // two corners meet: the area is (1 - t) (q0 - q2 t). If all three do, it is (1 - t)^2 q0
    const bool all_meet = b[0] == b[1] && b[1] == b[2];
    return all_meet || q0 - q2 > std::min(least_area, q0 / 2);
  }
  const double lowest_at = q2 > 0 ? -q1 / (2 * q2) : 1;
  if (lowest_at >= 1 || lowest_at <= 0) return true;
  return q0 + lowest_at * (q1 + lowest_at * q2) > std::min({least_area, q0 / 2, at_end / 2});
}

bool keeps_orientation(const Passage& p, double least_altitude) {
  return keeps_orientation({p[0], p[1], p[2]}, {p[3], p[4], p[5]}, least_altitude);
}

/// Is no side longer than that, before or after?
bool is_short(const Passage& p, double longest_units) {
  return std::max(longest(between(p[0], p[1]), between(p[0], p[2])),
                  longest(between(p[3], p[4]), between(p[3], p[5]))) <= longest_units;
}

FieldPoint field_point(const Place& place) {
  return {column_of(place.plan), row_of(place.plan), place.height_m};
}

}  // namespace

MorphGuard::MorphGuard(std::vector<Place> finer, std::vector<Corners> triangles,
                       const std::vector<TerrainVertex>& coarser, const SampleField& field,
                       const Placer& placer, double tolerance_m, double smallest_altitude_cells)
    : finer_(std::move(finer)),
      triangles_(std::move(triangles)),
      coarser_(coarser),
      field_(field),
      placer_(placer),
      tolerance_m_(tolerance_m),
      least_altitude_(kShareOfAltitude * smallest_altitude_cells * kUnitsPerCell),
      target_(finer_.size()),
      next_member_(finer_.size()),
      first_incident_(finer_.size() + 1, 0),
      incident_(triangles_.size() * 3),
      has_large_triangles_(field.sample_count() > kManySamples * triangles_.size()),
      checked_(triangles_.size(), 0),
      refused_(triangles_.size(), 0),
      left_(triangles_.size(), {0, 0, std::numeric_limits<double>::quiet_NaN()}) {
  for (std::uint32_t v = 0; v < finer_.size(); ++v) {
    target_[v] = VertexId{v};
    next_member_[v] = v;
  }
  for (const Corners& corners : triangles_) {
    for (const std::uint32_t v : corners) ++first_incident_[v + 1];
  }
  std::partial_sum(first_incident_.begin(), first_incident_.end(), first_incident_.begin());
  std::vector<std::uint32_t> free(first_incident_.begin(), first_incident_.end() - 1);
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    for (const std::uint32_t v : triangles_[t]) incident_[free[v]++] = t;
  }
}

void MorphGuard::begin_at(std::span<const std::uint32_t> target) {
  for (std::uint32_t v = 0; v < target.size(); ++v) {
    if (target[v] == v) continue;
    const VertexId core[] = {VertexId{v}, VertexId{target[v]}};
    join(core, core[1]);
  }
}

/// \param places  of the corners before and after.
bool MorphGuard::is_upright(const std::array<Place, 6>& places) const {
  Passage seen;
  std::ranges::transform(places, seen.begin(), plan_point, &Place::plan);
  if (!keeps_orientation(seen, least_altitude_)) return false;
  if (is_short(seen, placer_.longest_straight_units())) return true;
  placer_.look_down(places, seen);
  return keeps_orientation(seen, least_altitude_);
}

bool MorphGuard::refuses_at_a_look(std::uint32_t triangle, std::span<const VertexId> core,
                                   const Place& target) {
  std::array<Place, 6> places;
  std::array<FieldPoint, 3> begin, end;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t fine = triangles_[triangle][k];
    const VertexId coarse = target_[fine];
    places[k] = finer_[fine];
    places[3 + k] =
        std::ranges::find(core, coarse) != core.end() ? target : coarser_[index(coarse)].place;
    begin[k] = field_point(places[k]);
    end[k] = field_point(places[3 + k]);
  }
  if (!is_upright(places)) return true;
  movements_.push_back({triangle, MovingTriangle(begin, end, field_.slack_cells)});
  const FieldSample& left = left_[triangle];
  return !std::isnan(left.height_m) && movements_.back().moving.surely_leaves(left, tolerance_m_);
}

bool MorphGuard::do_all_stay_within() {
  constexpr std::size_t kNone = ~std::size_t{0};
  std::atomic<std::size_t> refusing = kNone;
  const auto look_at = [&](std::size_t i) {
    if (refusing.load(std::memory_order_relaxed) != kNone) return;
    const auto& [triangle, moving] = movements_[i];
    const std::optional<FieldSample> left = moving.find_left(field_, tolerance_m_);
    if (!left) return;
    left_[triangle] = *left;
    refusing = i;
  };
  if (has_large_triangles_) {
    for_each_within_task(movements_.size(), look_at);
  } else {
    for (std::size_t i = 0; i < movements_.size(); ++i) look_at(i);
  }
  if (refusing == kNone) return true;
  refused_[movements_[refusing].triangle] = stamp_;
  return false;
}

bool MorphGuard::allows(std::span<const VertexId> core, const Place& target) {
  list_moved(core);
  // what refused a place is likely to refuse the next one, too, for the sake of the same sample
  std::ranges::sort(moved_, std::ranges::greater(),
                    [&](std::uint32_t t) { return std::pair(refused_[t], t); });
  movements_.clear();
  for (const std::uint32_t triangle : moved_) {
    if (!refuses_at_a_look(triangle, core, target)) continue;
    refused_[triangle] = stamp_;
    return false;
  }
  return do_all_stay_within();
}

/// The fine triangles at the fine vertices of a core, each once.
void MorphGuard::list_moved(std::span<const VertexId> core) {
  ++stamp_;
  moved_.clear();
  for (const VertexId corner : core) {
    const auto first = static_cast<std::uint32_t>(corner);
    std::uint32_t fine = first;
    do {
      for (std::uint32_t i = first_incident_[fine]; i < first_incident_[fine + 1]; ++i) {
        const std::uint32_t t = incident_[i];
        if (std::exchange(checked_[t], stamp_) != stamp_) moved_.push_back(t);
      }
      fine = next_member_[fine];
    } while (fine != first);
  }
}

void MorphGuard::join(std::span<const VertexId> core, VertexId kept) {
  for (const VertexId corner : core) {
    if (corner == kept) continue;
    const auto first = static_cast<std::uint32_t>(corner);
    std::uint32_t fine = first;
    do {
      target_[fine] = kept;
      fine = next_member_[fine];
    } while (fine != first);
    // swapping the successors of two members joins their rings
    std::swap(next_member_[first], next_member_[static_cast<std::uint32_t>(kept)]);
  }
}

}  // namespace terrane::hierarchy

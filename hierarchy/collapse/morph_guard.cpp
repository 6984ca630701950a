#include "hierarchy/collapse/morph_guard.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "hierarchy/collapse/star_fit.h"

namespace terrane::hierarchy {
namespace {

struct PlanVector {
  double x, y;
};

PlanVector between(GridPoint a, GridPoint b) {
  return {static_cast<double>(b.x) - a.x, static_cast<double>(b.y) - a.y};
}

double cross(PlanVector a, PlanVector b) { return a.x * b.y - a.y * b.x; }

/// Does the triangle keep its orientation for all t in (0, 1) on its way from a to b?
/// Twice its area is the quadratic q0 + q1 t + q2 t^2.
bool keeps_orientation(const std::array<GridPoint, 3>& a, const std::array<GridPoint, 3>& b) {
  const PlanVector u0 = between(a[0], a[1]), v0 = between(a[0], a[2]);
  const PlanVector u1 = between(b[0], b[1]), v1 = between(b[0], b[2]);
  const PlanVector du{u1.x - u0.x, u1.y - u0.y}, dv{v1.x - v0.x, v1.y - v0.y};
  const double q0 = cross(u0, v0);
  const double q1 = cross(u0, dv) + cross(du, v0);
  const double q2 = cross(du, dv);
  const double at_end = cross(u1, v1);
  if (q0 <= 0 || at_end < 0) return false;
  const double lowest_at = q2 > 0 ? -q1 / (2 * q2) : 1;
  return lowest_at >= 1 || lowest_at <= 0 || q0 + lowest_at * (q1 + lowest_at * q2) > 0;
}

FieldPoint blend(const Place& from, const Place& to, double t) {
  const auto mix = [t](double p, double q) { return p + t * (q - p); };
  return {mix(column_of(from.plan), column_of(to.plan)), mix(row_of(from.plan), row_of(to.plan)),
          mix(from.height_m, to.height_m)};
}

}  // namespace

MorphGuard::MorphGuard(std::vector<Place> finer, std::vector<Corners> triangles,
                       const std::vector<TerrainVertex>& coarser, const SampleField& field,
                       double tolerance_m)
    : finer_(std::move(finer)),
      triangles_(std::move(triangles)),
      coarser_(coarser),
      field_(field),
      tolerance_m_(tolerance_m),
      target_(finer_.size()),
      next_member_(finer_.size()),
      first_incident_(finer_.size() + 1, 0),
      incident_(triangles_.size() * 3),
      checked_(triangles_.size(), 0) {
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

bool MorphGuard::is_sound(const Corners& triangle, std::span<const VertexId> core,
                          const Place& target) const {
  std::array<GridPoint, 3> from, to;
  std::array<const Place*, 3> end;
  for (std::size_t k = 0; k < 3; ++k) {
    const VertexId coarse = target_[triangle[k]];
    end[k] =
        std::ranges::find(core, coarse) != core.end() ? &target : &coarser_[index(coarse)].place;
    from[k] = finer_[triangle[k]].plan;
    to[k] = end[k]->plan;
  }
  if (!keeps_orientation(from, to)) return false;
  for (const double t : {0.25, 0.5, 0.75}) {
    if (!is_within(blend(finer_[triangle[0]], *end[0], t), blend(finer_[triangle[1]], *end[1], t),
                   blend(finer_[triangle[2]], *end[2], t), field_, tolerance_m_)) {
      return false;
    }
  }
  return true;
}

bool MorphGuard::allows(std::span<const VertexId> core, const Place& target) {
  ++stamp_;
  for (const VertexId corner : core) {
    const auto first = static_cast<std::uint32_t>(corner);
    std::uint32_t fine = first;
    do {
      for (std::uint32_t i = first_incident_[fine]; i < first_incident_[fine + 1]; ++i) {
        const std::uint32_t t = incident_[i];
        if (std::exchange(checked_[t], stamp_) == stamp_) continue;
        if (!is_sound(triangles_[t], core, target)) return false;
      }
      fine = next_member_[fine];
    } while (fine != first);
  }
  return true;
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

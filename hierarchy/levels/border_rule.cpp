#include "hierarchy/levels/border_rule.h"

#include <algorithm>
#include <cmath>

namespace terrane::hierarchy {
namespace {

/// cos 30 degrees: what turns more is a corner that a viewer sees.
const double kCornerCosine = std::sqrt(3.0) / 2;

/// Does the border run straight through b, from a to c?
bool is_straight(const LevelMesh& level, VertexId a, VertexId b, VertexId c) {
  if (level.mesh.is_split(b)) return false;
  const Eigen::Vector3d in = level.point(b) - level.point(a), out = level.point(c) - level.point(b);
  if (level.plan_sign != 0) {
    return in.x() * out.y() == in.y() * out.x() && in.x() * out.x() + in.y() * out.y() > 0;
  }
  return in.dot(out) > kCornerCosine * in.norm() * out.norm();
}

struct Neighbours {
  VertexId before, after;  // on the border, before and after the triangle
};

std::optional<Neighbours> border_neighbours(const LevelMesh& level, const Stencil& stencil) {
  const auto& polygon = stencil.polygon;
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (level.mesh.is_ghost(polygon[i])) {
      return Neighbours{polygon[(i + n - 1) % n], polygon[(i + 1) % n]};
    }
  }
  return std::nullopt;
}

std::optional<BorderRule> edge_rule(const LevelMesh& level, const Stencil& stencil,
                                    const Neighbours& next, std::uint32_t side, Rules rules) {
  BorderRule rule{BorderType::kEdge, std::nullopt, side};
  if (rules == Rules::kPublished) return rule;
  const std::uint32_t other = (side + 1) % 3;
  const VertexId a = stencil.core[side], b = stencil.core[other];
  const bool a_may_go = is_straight(level, next.before, a, b);
  const bool b_may_go = is_straight(level, a, b, next.after);
  if (!a_may_go && !b_may_go) return std::nullopt;
  if (!a_may_go) rule.onto = side;
  if (!b_may_go) rule.onto = other;
  if (rule.onto || level.plan_sign == 0) return rule;
  // the middle has to be a place of the lattice, else rounding would bend the line
  const Eigen::Vector3d middle = (level.point(a) + level.point(b)) / 2;
  if (level.lattice.round(middle).head<2>() != middle.head<2>()) rule.onto = side;
  return rule;
}

std::optional<BorderRule> corner_rule(const LevelMesh& level, const Stencil& stencil,
                                      const Neighbours& next, std::uint32_t corner, Rules rules) {
  const BorderRule rule{BorderType::kCorner, corner};
  if (rules == Rules::kPublished) return rule;
  const VertexId a = stencil.core[corner];
  const VertexId after = stencil.core[(corner + 1) % 3], before = stencil.core[(corner + 2) % 3];
  const bool may_go =
      is_straight(level, next.before, before, a) && is_straight(level, a, after, next.after);
  return may_go ? std::optional(rule) : std::nullopt;
}

}  // namespace

std::optional<BorderRule> border_rule(const LevelMesh& level, const Stencil& stencil, Rules rules) {
  const auto next = border_neighbours(level, stencil);
  if (!next) return BorderRule{};
  std::uint32_t border_sides = 0, side = 0, inner_side = 0;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const bool is_border = level.mesh.is_ghost(level.mesh.apex(stencil.dying[k]));
    border_sides += is_border;
    (is_border ? side : inner_side) = k;
  }
  if (border_sides == 1) return edge_rule(level, stencil, *next, side, rules);
  if (border_sides == 2) {
    return corner_rule(level, stencil, *next, (inner_side + 2) % 3, rules);
  }
  if (border_sides == 3) return std::nullopt;
  BorderRule rule{BorderType::kVertex, std::nullopt};
  for (std::uint32_t k = 0; k < 3; ++k) {
    if (level.on_border[index(stencil.core[k])]) rule.onto = k;
  }
  return rule;
}

}  // namespace terrane::hierarchy

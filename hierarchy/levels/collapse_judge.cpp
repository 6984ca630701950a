#include "hierarchy/levels/collapse_judge.h"

#include <algorithm>
#include <cmath>

namespace terrane::hierarchy {
namespace {

/// Six coefficients from as many points as the stencil of a regular mesh has: with fewer the fit
/// follows single points and its curvature is noise.
constexpr std::size_t kEnoughPoints = 12;
/// A mesh that is still singular after so many rings is a plane, or tiny.
constexpr int kMostRings = 4;

/// A quadratic through few points may shoot far off: places stay where the lattice is exact.
bool is_on_lattice(const Eigen::Vector3d& point, const PointLattice& lattice) {
  constexpr double kMostSteps = 1 << 23;
  return point.cwiseAbs().maxCoeff() < kMostSteps * lattice.step();
}

}  // namespace

CollapseJudge::CollapseJudge(const LevelMesh& level, Rules rules)
    : level_(level), rules_(rules), walker_(level.mesh, CornerTriangles::kMayCollapse) {}

std::optional<TriangleFrame> CollapseJudge::frame(TriangleId t) const {
  const HalfedgeId h = HalfedgeMesh::halfedge(t, 0);
  return TriangleFrame::of(level_.point(level_.mesh.start(h)), level_.point(level_.mesh.end(h)),
                           level_.point(level_.mesh.apex(h)));
}

void CollapseJudge::add_ancestors(VertexId v, const TriangleFrame& frame) {
  level_.ancestors.for_each(v, [&](const Eigen::Vector3i& p) {
    fitter_.add(frame.to_local(level_.lattice.relative(p)));
  });
}

/// Adds the vertices next to the outermost ring; false if there are none.
bool CollapseJudge::widen() {
  const std::size_t end = ring_.size();
  for (std::size_t i = ring_begin_; i < end; ++i) {
    const HalfedgeId first = level_.mesh.outgoing(ring_[i]);
    HalfedgeId h = first;
    do {
      const VertexId v = level_.mesh.end(h);
      if (!level_.mesh.is_ghost(v) && std::ranges::find(ring_, v) == ring_.end()) {
        ring_.push_back(v);
      }
      h = level_.mesh.rotate(h);
    } while (h != first);
  }
  ring_begin_ = end;
  return ring_.size() > end;
}

LocalSurface CollapseJudge::surface(TriangleId t, const TriangleFrame& frame) {
  ring_.clear();
  ring_begin_ = 0;
  fitter_.clear();
  for (std::uint32_t k = 0; k < 3; ++k) {
    ring_.push_back(level_.mesh.start(HalfedgeMesh::halfedge(t, k)));
    add_ancestors(ring_.back(), frame);
  }
  bool is_enough = fitter_.size() >= kEnoughPoints;
  for (int rings = 0; rings <= kMostRings; ++rings) {
    if (is_enough) {
      if (const auto fitted = fitter_.fit()) return *fitted;
    }
    if (!widen()) break;
    for (std::size_t i = ring_begin_; i < ring_.size(); ++i) add_ancestors(ring_[i], frame);
    is_enough = true;
  }
  return {};
}

bool CollapseJudge::find_stencil(TriangleId t) {
  switch (walker_.around_triangle(t, stencil_)) {
    case Collapsibility::kYes:
      break;
    case Collapsibility::kValence:
      rejection_ = Rejection::kValence;
      return false;
    default:
      rejection_ = Rejection::kCyclic;
      return false;
  }
  // the new vertex may not have valence 3 itself, unless it is a corner of the border
  const bool is_inside =
      std::ranges::none_of(stencil_.polygon, [&](VertexId v) { return level_.mesh.is_ghost(v); });
  if (stencil_.polygon.size() < (is_inside ? 4U : 3U)) {
    rejection_ = Rejection::kValence;
    return false;
  }
  return true;
}

std::optional<CollapsePlan> CollapseJudge::place(const TriangleFrame& frame,
                                                 const LocalSurface& surface) {
  const auto rule = border_rule(level_, stencil_, rules_);
  if (!rule) {
    rejection_ = Rejection::kBoundary;
    return std::nullopt;
  }
  CollapsePlan plan{level_.lattice.round(collapse_point(*rule, frame, surface)),
                    rule->onto.value_or(0)};
  if (!is_on_lattice(plan.point, level_.lattice) || !sees_polygon(plan.point, frame)) {
    rejection_ = Rejection::kNotStarShaped;
    return std::nullopt;
  }
  if (rules_ == Rules::kTightened && level_.plan_sign != 0 && !sees_polygon_in_plan(plan.point)) {
    rejection_ = Rejection::kFolded;
    return std::nullopt;
  }
  return plan;
}

Eigen::Vector3d CollapseJudge::collapse_point(const BorderRule& rule, const TriangleFrame& frame,
                                              const LocalSurface& surface) const {
  if (rule.onto) return level_.point(stencil_.core[*rule.onto]);
  if (rule.type == BorderType::kInside) return frame.to_world({0, 0, surface.at(0, 0)});
  const Eigen::Vector3d middle =
      (level_.point(stencil_.core[rule.side]) + level_.point(stencil_.core[(rule.side + 1) % 3])) /
      2;
  const Eigen::Vector3d local = frame.to_local(middle);
  if (rules_ == Rules::kPublished || level_.plan_sign == 0) {
    return frame.to_world({local.x(), local.y(), surface.at(local.x(), local.y())});
  }
  // straight up or down to the surface, not along n: that would leave the line
  const double rise = surface.distance_along(local, frame.direction(Eigen::Vector3d::UnitZ()));
  return middle + Eigen::Vector3d(0, 0, rise);
}

bool CollapseJudge::sees_polygon(const Eigen::Vector3d& point, const TriangleFrame& frame) const {
  const auto& polygon = stencil_.polygon;
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    const VertexId a = polygon[i], b = polygon[i + 1 == n ? 0 : i + 1];
    if (level_.mesh.is_ghost(a) || level_.mesh.is_ghost(b)) continue;
    const Eigen::Vector3d normal = (level_.point(a) - point).cross(level_.point(b) - point);
    if (!(normal.dot(frame.normal()) > 0)) return false;
  }
  return true;
}

bool CollapseJudge::sees_polygon_in_plan(const Eigen::Vector3d& point) const {
  const auto& polygon = stencil_.polygon;
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    const VertexId a = polygon[i], b = polygon[i + 1 == n ? 0 : i + 1];
    if (level_.mesh.is_ghost(a) || level_.mesh.is_ghost(b)) continue;
    if (!(level_.plan_area(point, level_.point(a), level_.point(b)) > 0)) return false;
  }
  return true;
}

double CollapseJudge::predictive_error(const TriangleFrame& frame, const LocalSurface& surface,
                                       const CollapsePlan& plan) const {
  const auto& polygon = stencil_.polygon;
  const Eigen::Vector3d centre = frame.to_local(plan.point);
  double largest = 0;
  Eigen::Vector3d before;
  bool has_before = !level_.mesh.is_ghost(polygon.back());
  if (has_before) before = frame.to_local(level_.point(polygon.back()));
  for (const VertexId v : polygon) {
    const bool is_real = !level_.mesh.is_ghost(v);
    if (is_real) {
      const Eigen::Vector3d here = frame.to_local(level_.point(v));
      largest = std::max(largest, surface.edge_error(centre, here));
      if (has_before) largest = std::max(largest, surface.edge_error(before, here));
      before = here;
    }
    has_before = is_real;
  }
  return largest;
}

}  // namespace terrane::hierarchy

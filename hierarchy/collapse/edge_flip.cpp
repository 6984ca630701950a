#include "hierarchy/collapse/edge_flip.h"

#include <cmath>

#include "hierarchy/collapse/triangle_plane.h"

namespace terrane::hierarchy {
namespace {

// a flip has to save this share of the squared error: equal ones would go back and forth
constexpr double kLeastGain = 1e-3;

}  // namespace

bool EdgeFlip::is_better(HalfedgeId h, const HalfedgeMesh& mesh,
                         std::span<const TerrainVertex> vertices, const CoveredSamples& samples,
                         double tolerance_m, const ShapeLimits& limits, const Placer& placer) {
  const HalfedgeId o = mesh.opposite(h);
  const TriangleId t0 = HalfedgeMesh::triangle(h), t1 = HalfedgeMesh::triangle(o);
  if (mesh.is_ghost(t0) || mesh.is_ghost(t1)) return false;
  const VertexId va = mesh.start(h), vb = mesh.start(o);
  if (mesh.valence(va) <= 4 || mesh.valence(vb) <= 4) return false;
  const VertexId vc = mesh.apex(h), vd = mesh.apex(o);
  const auto is_inside = [&](VertexId v) {
    return vertices[index(v)].kind == VertexKind::kInterior;
  };
  if (!(is_inside(va) || is_inside(vb)) || !(is_inside(vc) || is_inside(vd))) return false;
  const Place &a = vertices[index(va)].place, &b = vertices[index(vb)].place;
  const Place &c = vertices[index(vc)].place, &d = vertices[index(vd)].place;
  if (!is_well_shaped(a, d, c, limits, placer) || !is_well_shaped(b, c, d, limits, placer)) {
    return false;
  }

  const TrianglePlane before[] = {{a, b, c}, {b, a, d}}, after[] = {{a, d, c}, {b, c, d}};
  const double dx = static_cast<double>(c.plan.x) - d.plan.x;
  const double dy = static_cast<double>(c.plan.y) - d.plan.y;
  double old_square = 0, new_square = 0;
  samples_.clear();
  sector_.clear();
  const auto judge = [&](std::span<const CoveredSample> under, const TrianglePlane& now) {
    for (const CoveredSample& sample : under) {
      const double x = double{sample.column} * kUnitsPerCell - d.plan.x;
      const double y = -double{sample.row} * kUnitsPerCell - d.plan.y;
      const std::uint32_t sector = dx * y - dy * x >= 0 ? 0 : 1;
      const double error_m = after[sector].error_m(sample);
      if (!(std::abs(error_m) <= tolerance_m)) return false;
      const double old_m = now.error_m(sample);
      old_square += old_m * old_m;
      new_square += error_m * error_m;
      samples_.push_back(sample);
      sector_.push_back(sector);
    }
    return true;
  };
  if (!judge(samples.keen_under(t0), before[0]) || !judge(samples.keen_under(t1), before[1])) {
    return false;
  }
  keen_count_ = samples_.size();
  if (!judge(samples.others_under(t0), before[0]) || !judge(samples.others_under(t1), before[1])) {
    return false;
  }
  return new_square < (1 - kLeastGain) * old_square;
}

}  // namespace terrane::hierarchy

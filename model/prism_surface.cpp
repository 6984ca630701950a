#include "model/prism_surface.h"

#include <fmt/format.h>
#include <geos_c.h>

#include <algorithm>
#include <map>
#include <memory>
#include <numeric>

#include "core/errors.h"

namespace terrane::model {
namespace {

using hierarchy::volume::Box;
using hierarchy::volume::SurfaceMesh;
using Ring = std::vector<PlanPosition>;

/// GEOS's C interface with its memory in order.
class Geos {
 public:
  Geos() : context_(GEOS_init_r()) {}
  ~Geos() { GEOS_finish_r(context_); }
  Geos(const Geos&) = delete;
  Geos& operator=(const Geos&) = delete;

  struct Delete {
    GEOSContextHandle_t context;
    void operator()(GEOSGeometry* geometry) const { GEOSGeom_destroy_r(context, geometry); }
  };
  using Geometry = std::unique_ptr<GEOSGeometry, Delete>;

  GEOSContextHandle_t context() const { return context_; }
  Geometry own(GEOSGeometry* geometry) const { return {geometry, Delete{context_}}; }

 private:
  GEOSContextHandle_t context_;
};

GEOSGeometry* ring_of(const Geos& geos, const Ring& ring) {
  GEOSCoordSequence* points =
      GEOSCoordSeq_create_r(geos.context(), static_cast<unsigned>(ring.size() + 1), 2);
  for (std::size_t i = 0; i <= ring.size(); ++i) {
    const PlanPosition p = ring[i % ring.size()];
    GEOSCoordSeq_setXY_r(geos.context(), points, static_cast<unsigned>(i), p.x, p.y);
  }
  return GEOSGeom_createLinearRing_r(geos.context(), points);
}

Geos::Geometry polygon_of(const Geos& geos, const std::string& name, const Ring& outline,
                          const std::vector<Ring>& holes) {
  std::vector<GEOSGeometry*> inner;
  for (const Ring& hole : holes) inner.push_back(ring_of(geos, hole));
  auto polygon = geos.own(GEOSGeom_createPolygon_r(
      geos.context(), ring_of(geos, outline), inner.data(), static_cast<unsigned>(inner.size())));
  if (polygon == nullptr || GEOSisValid_r(geos.context(), polygon.get()) != 1) {
    char* reason =
        polygon == nullptr ? nullptr : GEOSisValidReason_r(geos.context(), polygon.get());
    const std::string why = reason == nullptr ? "too few points" : reason;
    if (reason != nullptr) GEOSFree_r(geos.context(), reason);
    throw InputError(
        fmt::format("{}: a polygon is not valid ({}, in metres of the model). Mend it", name, why));
  }
  return polygon;
}

Ring to_plan(const Ring& ring, const PlanFrame& frame) {
  Ring plan;
  for (const PlanPosition p : ring) {
    plan.push_back(frame.is_on_earth() ? frame.from_lon_lat({p.x, p.y}) : p);
  }
  return plan;
}

/// Vertices of rings, at the top; those of the bottom follow with the same order.
class PrismBuilder {
 public:
  PrismBuilder(double top, double bottom) : top_(top), bottom_(bottom) {}

  void add_triangle(PlanPosition a, PlanPosition b, PlanPosition c) {
    if ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) < 0) std::swap(b, c);
    const std::uint32_t i = vertex(a), j = vertex(b), k = vertex(c);
    top_triangles_.push_back({i, j, k});
  }

  SurfaceMesh finish() {
    part_fans();
    SurfaceMesh mesh;
    const auto count = static_cast<std::uint32_t>(vertices_.size());
    for (const double z : {top_, bottom_}) {
      for (const PlanPosition p : vertices_) mesh.points.emplace_back(p.x, p.y, z);
    }
    const auto sides = triangles_at_sides();
    for (std::uint32_t t = 0; t < top_triangles_.size(); ++t) {
      const auto& corner = top_triangles_[t];
      mesh.triangles.push_back(corner);
      mesh.triangles.push_back({corner[0] + count, corner[2] + count, corner[1] + count});
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t a = corner[k], b = corner[(k + 1) % 3];
        // a side of one triangle only is where the prism has a wall
        if (sides.at(std::minmax(a, b)).size() > 1) continue;
        mesh.triangles.push_back({b, a, a + count});
        mesh.triangles.push_back({b, a + count, b + count});
      }
    }
    return mesh;
  }

 private:
  using Side = std::pair<std::uint32_t, std::uint32_t>;

  std::map<Side, std::vector<std::uint32_t>> triangles_at_sides() const {
    std::map<Side, std::vector<std::uint32_t>> sides;
    for (std::uint32_t t = 0; t < top_triangles_.size(); ++t) {
      const auto& corner = top_triangles_[t];
      for (int k = 0; k < 3; ++k) {
        sides[std::minmax(corner[k], corner[(k + 1) % 3])].push_back(t);
      }
    }
    return sides;
  }

  // Where two parts of the water touch in a point, each gets a vertex of its own: else four walls
  // would meet at one edge. Triangles of a part hang together by their sides.
  void part_fans() {
    std::vector<std::uint32_t> fan(3 * top_triangles_.size());
    std::iota(fan.begin(), fan.end(), 0u);
    const auto root = [&](std::uint32_t c) {
      while (fan[c] != c) c = fan[c] = fan[fan[c]];
      return c;
    };
    const auto corner_at = [&](std::uint32_t t, std::uint32_t vertex) {
      const auto& corner = top_triangles_[t];
      const auto k = std::ranges::find(corner, vertex) - corner.begin();
      return 3 * t + static_cast<std::uint32_t>(k);
    };
    for (const auto& [side, triangles] : triangles_at_sides()) {
      if (triangles.size() < 2) continue;
      for (const std::uint32_t vertex : {side.first, side.second}) {
        const std::uint32_t a = root(corner_at(triangles[0], vertex));
        const std::uint32_t b = root(corner_at(triangles[1], vertex));
        fan[std::max(a, b)] = std::min(a, b);
      }
    }
    std::vector<std::uint32_t> first_fan(vertices_.size(), ~0u);
    std::map<std::uint32_t, std::uint32_t> copies;
    for (std::uint32_t c = 0; c < fan.size(); ++c) {
      std::uint32_t& vertex = top_triangles_[c / 3][c % 3];
      if (first_fan[vertex] == ~0u) first_fan[vertex] = root(c);
      if (first_fan[vertex] == root(c)) continue;
      const auto [copy, is_new] =
          copies.try_emplace(root(c), static_cast<std::uint32_t>(vertices_.size()));
      if (is_new) vertices_.push_back(PlanPosition(vertices_[vertex]));
      vertex = copy->second;
    }
  }

  std::uint32_t vertex(PlanPosition p) {
    const auto [at, is_new] = numbers_.try_emplace({p.x, p.y}, vertices_.size());
    if (is_new) vertices_.push_back(p);
    return at->second;
  }

  double top_, bottom_;
  std::vector<PlanPosition> vertices_;
  std::map<std::pair<double, double>, std::uint32_t> numbers_;
  std::vector<std::array<std::uint32_t, 3>> top_triangles_;
};

void add_top(const Geos& geos, const GEOSGeometry* polygon, PrismBuilder& prism) {
  const auto triangles = geos.own(GEOSConstrainedDelaunayTriangulation_r(geos.context(), polygon));
  const int count = GEOSGetNumGeometries_r(geos.context(), triangles.get());
  for (int i = 0; i < count; ++i) {
    const GEOSGeometry* triangle = GEOSGetGeometryN_r(geos.context(), triangles.get(), i);
    const GEOSCoordSequence* points =
        GEOSGeom_getCoordSeq_r(geos.context(), GEOSGetExteriorRing_r(geos.context(), triangle));
    std::array<PlanPosition, 3> corner;
    for (unsigned k = 0; k < 3; ++k) {
      GEOSCoordSeq_getXY_r(geos.context(), points, k, &corner[k].x, &corner[k].y);
    }
    prism.add_triangle(corner[0], corner[1], corner[2]);
  }
}

}  // namespace

SurfaceMesh prism_surface(const std::string& name, const ingest::PolygonFile& polygons,
                          double level, const PlanFrame& frame, const Box& box) {
  if (polygons.is_geographic != frame.is_on_earth()) {
    throw InputError(fmt::format("{}: {} a CRS, but the model {}. Give both one, or none", name,
                                 polygons.is_geographic ? "has" : "has not",
                                 frame.is_on_earth() ? "is on Earth" : "is not on Earth"));
  }
  const Geos geos;
  PrismBuilder prism(level, box.low.z() - 0.1 * box.size().z() - 1);
  for (const ingest::Polygon& polygon : polygons.polygons) {
    std::vector<Ring> holes;
    for (const Ring& hole : polygon.holes) holes.push_back(to_plan(hole, frame));
    const auto area = polygon_of(geos, name, to_plan(polygon.outline, frame), holes);
    add_top(geos, area.get(), prism);
  }
  return prism.finish();
}

}  // namespace terrane::model

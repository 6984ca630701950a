#include "hierarchy/collapse/boundary_rule.h"

#include <algorithm>

namespace terrane::hierarchy {
namespace {

/// Does m lie on the straight line between a and b, and strictly between them?
bool is_between(const BorderPlace& m, const BorderPlace& a, const BorderPlace& b) {
  const double ax = a.column - m.column, ay = a.row - m.row;
  const double bx = b.column - m.column, by = b.row - m.row;
  return ax * by - ay * bx == 0 && ax * bx + ay * by < 0;
}

/// The outline's next vertices on both sides of the core.
struct OutlineNeighbours {
  VertexId before, after;
};

std::optional<OutlineNeighbours> outline_neighbours(const Stencil& stencil,
                                                    const HalfedgeMesh& mesh) {
  const auto& polygon = stencil.polygon;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    if (!mesh.is_ghost(polygon[i])) continue;
    return OutlineNeighbours{polygon[(i + polygon.size() - 1) % polygon.size()],
                             polygon[(i + 1) % polygon.size()]};
  }
  return std::nullopt;
}

bool share_outline_edge(const Stencil& stencil, const HalfedgeMesh& mesh, VertexId a, VertexId b) {
  return std::ranges::any_of(stencil.dying_span(), [&](HalfedgeId h) {
    const VertexId from = mesh.start(h), to = mesh.end(h);
    const bool joins = (from == a && to == b) || (from == b && to == a);
    return joins && (mesh.is_ghost(mesh.apex(h)) || mesh.is_ghost(mesh.apex(mesh.opposite(h))));
  });
}

bool may_give_way(VertexId v, VertexId onto, const OutlineNeighbours& neighbours,
                  std::span<const TerrainVertex> vertices, const Placer& placer) {
  const TerrainVertex& moving = vertices[index(v)];
  const TerrainVertex& target = vertices[index(onto)];
  if (moving.kind != VertexKind::kOutline) return false;
  for (const VertexId other : {neighbours.before, neighbours.after}) {
    const TerrainVertex& far_end = vertices[index(other)];
    // where a line ends on the outline between two samples, the outline stays as it is
    if (!target.border.is_sample() || !far_end.border.is_sample()) continue;
    if (is_between(moving.border, target.border, far_end.border)) {
      return placer.is_straight(target.place, far_end.place);
    }
  }
  return false;
}

}  // namespace

BoundaryVerdict classify(const Stencil& stencil, const HalfedgeMesh& mesh,
                         std::span<const TerrainVertex> vertices, const Placer& placer,
                         const LineChains* lines) {
  std::array<VertexId, 3> on_line{};
  std::size_t count = 0;
  for (const VertexId v : stencil.core_span()) {
    if (vertices[index(v)].kind != VertexKind::kInterior) on_line[count++] = v;
  }
  if (count == 0) return {BoundaryType::kInterior, std::nullopt};
  if (count == 1) return {BoundaryType::kVertex, on_line[0]};

  if (count == 3) return {};
  const auto [a, b] = std::pair{on_line[0], on_line[1]};
  if (lines != nullptr && lines->joins(a, b)) {
    if (lines->may_drop(b, a, vertices)) return {BoundaryType::kEdge, a};
    if (lines->may_drop(a, b, vertices)) return {BoundaryType::kEdge, b};
    return {};
  }
  const auto neighbours = outline_neighbours(stencil, mesh);
  if (!neighbours) return {};
  if (!share_outline_edge(stencil, mesh, a, b)) return {};
  if (may_give_way(b, a, *neighbours, vertices, placer)) return {BoundaryType::kEdge, a};
  if (may_give_way(a, b, *neighbours, vertices, placer)) return {BoundaryType::kEdge, b};
  return {};
}

}  // namespace terrane::hierarchy

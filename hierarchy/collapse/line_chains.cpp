#include "hierarchy/collapse/line_chains.h"

#include <algorithm>
#include <utility>

namespace terrane::hierarchy {

LineChains::LineChains(std::span<const LineEdge> edges, std::size_t vertex_count,
                       const LineTolerance& tolerance)
    : tolerance_(tolerance), node_of_(vertex_count, 0), nodes_(1) {
  for (const auto& [a, b] : edges) {
    const auto edge = static_cast<std::uint32_t>(edges_.size());
    edges_.push_back({VertexId{a}, VertexId{b}, {}});
    for (const VertexId v : {VertexId{a}, VertexId{b}}) {
      if (node_of_[v] == 0) {
        node_of_[v] = static_cast<std::uint32_t>(nodes_.size());
        nodes_.emplace_back();
      }
      nodes_[node_of_[v]].push_back(edge);
    }
  }
}

const std::vector<std::uint32_t>& LineChains::edges_of(VertexId v) const {
  return nodes_[node_of_[v]];
}

bool LineChains::joins(VertexId a, VertexId b) const {
  return std::ranges::any_of(edges_of(a), [&](std::uint32_t e) { return edges_[e].other(a) == b; });
}

LineChains::Turn LineChains::turn(VertexId v, VertexId onto) const {
  const auto& both = edges_of(v);
  const bool is_first = edges_[both[0]].other(v) == onto;
  return is_first ? Turn{both[0], both[1]} : Turn{both[1], both[0]};
}

bool LineChains::may_drop(VertexId v, VertexId onto,
                          std::span<const TerrainVertex> vertices) const {
  if (edges_of(v).size() != 2 || vertices[index(v)].kind != VertexKind::kFeature) return false;
  const auto [back, ahead] = turn(v, onto);
  const VertexId far_end = edges_[ahead].other(v);
  if (far_end == onto || joins(onto, far_end)) return false;
  const GridPoint from = vertices[index(onto)].place.plan;
  const GridPoint to = vertices[index(far_end)].place.plan;
  const auto all_near = [&](const std::vector<GridPoint>& points) {
    return std::ranges::all_of(points, [&](GridPoint p) { return is_near(p, from, to); });
  };
  return is_near(vertices[index(v)].place.plan, from, to) && all_near(edges_[back].dropped) &&
         all_near(edges_[ahead].dropped);
}

void LineChains::drop(VertexId v, VertexId onto, std::span<const TerrainVertex> vertices) {
  const auto [back, ahead] = turn(v, onto);
  const VertexId far_end = edges_[ahead].other(v);
  Edge& kept = edges_[back];
  kept.dropped.push_back(vertices[index(v)].place.plan);
  kept.dropped.insert(kept.dropped.end(), edges_[ahead].dropped.begin(),
                      edges_[ahead].dropped.end());
  kept.a = onto;
  kept.b = far_end;
  edges_[ahead].is_live = false;
  std::ranges::replace(nodes_[node_of_[far_end]], ahead, back);
  nodes_[node_of_[v]].clear();
}

std::vector<LineEdge> LineChains::edges() const {
  std::vector<LineEdge> result;
  for (const Edge& edge : edges_) {
    if (!edge.is_live) continue;
    const auto [a, b] = std::minmax(edge.a, edge.b);
    result.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)});
  }
  return result;
}

bool LineChains::is_near(GridPoint p, GridPoint from, GridPoint to) const {
  const auto from_m = [&](GridPoint q) {
    return std::pair{(static_cast<double>(q.x) - from.x) * tolerance_.column_m / kUnitsPerCell,
                     (static_cast<double>(q.y) - from.y) * tolerance_.row_m / kUnitsPerCell};
  };
  const auto [px, py] = from_m(p);
  const auto [dx, dy] = from_m(to);
  const double length2 = dx * dx + dy * dy;
  const double t = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0;
  const double x = px - t * dx, y = py - t * dy;
  return x * x + y * y <= tolerance_.most_m * tolerance_.most_m;
}

}  // namespace terrane::hierarchy

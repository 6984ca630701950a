#pragma once

#include <span>
#include <vector>

#include "hierarchy/collapse/terrain_mesh.h"
#include "hierarchy/mesh/ids.h"

namespace terrane::hierarchy {

/// How near lines stay to their place.
struct LineTolerance {
  double most_m = 0;    ///< largest distance in plan of a dropped vertex from its line
  double column_m = 1;  ///< distance of two samples of a row
  double row_m = 1;     ///< distance of two samples of a column
};

/// The lines of a mesh while it collapses: who is joined to whom, and which vertices were dropped
/// along the way.
///
/// A line gives way only along itself: one of its vertices goes onto the next one, and every vertex
/// that was dropped between the two stays within the tolerance of the straight edge. Ends and
/// junctions stay, and so does the last triangle of a ring: an island never vanishes.
class LineChains {
 public:
  LineChains(std::span<const LineEdge> edges, std::size_t vertex_count,
             const LineTolerance& tolerance);

  /// Is there a line edge between them?
  bool joins(VertexId a, VertexId b) const;

  /// May v go along the line onto its neighbour?
  /// \pre joins(v, onto).
  bool may_drop(VertexId v, VertexId onto, std::span<const TerrainVertex> vertices) const;

  /// Tells that it did.
  /// \pre may_drop(v, onto).
  void drop(VertexId v, VertexId onto, std::span<const TerrainVertex> vertices);

  /// The edges that are left, in the order in which they were given.
  std::vector<LineEdge> edges() const;

 private:
  struct Edge {
    VertexId a, b;
    std::vector<GridPoint> dropped;  ///< between a and b
    bool is_live = true;

    VertexId other(VertexId v) const { return v == a ? b : a; }
  };

  const std::vector<std::uint32_t>& edges_of(VertexId v) const;
  /// The edge between them, and the one by which the line goes on at v.
  struct Turn {
    std::uint32_t back, ahead;
  };
  Turn turn(VertexId v, VertexId onto) const;
  bool is_near(GridPoint p, GridPoint from, GridPoint to) const;

  LineTolerance tolerance_;
  std::vector<Edge> edges_;
  IdVector<VertexId, std::uint32_t> node_of_;
  std::vector<std::vector<std::uint32_t>> nodes_;  ///< edges at a vertex; the first is nobody's
};

}  // namespace terrane::hierarchy

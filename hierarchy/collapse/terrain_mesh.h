#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/lattice_point.h"
#include "hierarchy/mesh/border_place.h"
#include "hierarchy/mesh/grid_point.h"
#include "hierarchy/mesh/grid_triangles.h"
#include "hierarchy/mesh/halfedge_mesh.h"
#include "hierarchy/mesh/lined_triangles.h"

namespace terrane::hierarchy {

/// A position as it is written: the integers, and where they come to lie over the grid.
struct Place {
  GridPoint plan;
  double height_m = 0;  ///< over the curved datum of the SampleField
  LatticePoint lattice;
};

enum class VertexKind : std::uint8_t {
  kInterior,
  kOutline,  ///< on the edge of the valid data; may slide along straight stretches of it
  kFeature,  ///< on a line; may slide along it within the tolerance in plan
  kLocked,   ///< on a seam, a tile corner, or where two holes touch: stays
};

struct TerrainVertex {
  Place place;
  VertexKind kind = VertexKind::kInterior;
  BorderPlace border = {};  ///< of an outline or locked vertex
  /// Height over the ellipsoid of the water that an interior vertex lies in; NaN on land.
  float water_m = std::numeric_limits<float>::quiet_NaN();
};

struct TerrainMesh {
  std::vector<TerrainVertex> vertices;
  std::vector<Corners> triangles;  ///< counter-clockwise in GridPoint's plane
  std::vector<LineEdge> lines;     ///< edges that stay edges; their ends are kFeature or kLocked
  std::vector<std::uint8_t> in_water = {};  ///< of each triangle, 1 or 0; empty: all are on land
};

/// A place in plan where it need not be one of the grid's: x and y as in GridPoint.
struct PlanPoint {
  double x = 0, y = 0;

  bool operator==(const PlanPoint&) const = default;
};

inline PlanPoint plan_point(GridPoint p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y)};
}

/// Rounds places to the written lattice, and knows how the world has them.
class Placer {
 public:
  virtual ~Placer() = default;

  /// The written place nearest to a wished one.
  virtual Place place(GridPoint plan, double height_m) const = 0;

  /// What a height over the ellipsoid is over the datum that place() counts from.
  virtual double over_datum_m(GridPoint /*plan*/, double height_m) const { return height_m; }

  /// How far in plan the straight edge between two written places lies beside the straight line
  /// between them on the grid, in metres.
  virtual double bend_m(const Place& /*a*/, const Place& /*b*/) const { return 0; }

  /// Is the straight edge between two written places near enough to the straight line between them
  /// on the grid, so that samples on that line count as covered?
  virtual bool is_straight(const Place& a, const Place& b) const = 0;

  /// Length over the grid, in grid units, up to which a triangle's sides are so straight in the
  /// world that it is upright there if it is so over the grid.
  virtual double longest_straight_units() const { return std::numeric_limits<double>::infinity(); }

  /// Some places seen from above as the world has them, where edges are straight: along the plumb
  /// line in their middle, in grid units of a cell's shorter side.
  virtual void look_down(std::span<const Place> places, std::span<PlanPoint> seen) const {
    for (std::size_t k = 0; k < places.size(); ++k) seen[k] = plan_point(places[k].plan);
  }
};

}  // namespace terrane::hierarchy

#include "hierarchy/collapse/triangle_shape.h"

#include <algorithm>
#include <array>

#include "hierarchy/collapse/triangle_plane.h"

namespace terrane::hierarchy {
namespace {

double squared_length(double x, double y) { return x * x + y * y; }

double squared_length(GridPoint a, GridPoint b) {
  return squared_length(static_cast<double>(b.x) - a.x, static_cast<double>(b.y) - a.y);
}

double squared_length(const PlanPoint& a, const PlanPoint& b) {
  return squared_length(b.x - a.x, b.y - a.y);
}

/// altitude = twice the area / longest side; squared, as roots took a quarter of all the time.
bool is_thick(double twice_area, double longest2, double altitude) {
  return twice_area > 0 && twice_area * twice_area >= longest2 * altitude * altitude;
}

bool is_upright_in_world(const std::array<Place, 3>& corners, double altitude,
                         const Placer& placer) {
  std::array<PlanPoint, 3> seen;
  placer.look_down(corners, seen);
  const auto& [a, b, c] = seen;
  const double twice_area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  const double longest2 =
      std::max({squared_length(a, b), squared_length(b, c), squared_length(c, a)});
  return is_thick(twice_area, longest2, altitude);
}

}  // namespace

bool is_upright(const Place& a, const Place& b, const Place& c, double smallest_altitude_cells,
                const Placer& placer) {
  const double altitude = smallest_altitude_cells * kUnitsPerCell;
  const double longest2 = std::max({squared_length(a.plan, b.plan), squared_length(b.plan, c.plan),
                                    squared_length(c.plan, a.plan)});
  if (!is_thick(static_cast<double>(orient2d(a.plan, b.plan, c.plan)), longest2, altitude)) {
    return false;
  }
  const double straight = placer.longest_straight_units();
  return longest2 <= straight * straight || is_upright_in_world({a, b, c}, altitude, placer);
}

bool is_well_shaped(const Place& a, const Place& b, const Place& c, const ShapeLimits& limits,
                    const Placer& placer) {
  return is_upright(a, b, c, limits.smallest_altitude_cells, placer) &&
         TrianglePlane(a, b, c).squared_rise_m2() <= limits.steepest_m * limits.steepest_m;
}

}  // namespace terrane::hierarchy

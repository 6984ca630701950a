#include "hierarchy/collapse/triangle_shape.h"

#include <algorithm>
#include <array>

#include "hierarchy/collapse/triangle_plane.h"

namespace terrane::hierarchy {
namespace {

double squared_length(const PlanPoint& a, const PlanPoint& b) {
  const double x = b.x - a.x, y = b.y - a.y;
  return x * x + y * y;
}

double squared_longest(const PlanPoint& a, const PlanPoint& b, const PlanPoint& c) {
  return std::max({squared_length(a, b), squared_length(b, c), squared_length(c, a)});
}

double squared_longest(GridPoint a, GridPoint b, GridPoint c) {
  return squared_longest(plan_point(a), plan_point(b), plan_point(c));
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
  return is_thick(twice_area, squared_longest(a, b, c), altitude);
}

}  // namespace

double squared_altitude(GridPoint a, GridPoint b, GridPoint c) {
  const auto twice_area = static_cast<double>(orient2d(a, b, c));
  return twice_area <= 0 ? 0 : twice_area * twice_area / squared_longest(a, b, c);
}

bool is_upright(const Place& a, const Place& b, const Place& c, double smallest_altitude_cells,
                const Placer& placer) {
  const double altitude = smallest_altitude_cells * kUnitsPerCell;
  const double longest2 = squared_longest(a.plan, b.plan, c.plan);
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

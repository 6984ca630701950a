#pragma once

#include <limits>

#include "hierarchy/collapse/terrain_mesh.h"

namespace terrane::hierarchy {

/// What a triangle must be to be written, whatever it covers.
struct ShapeLimits {
  /// Smallest altitude in plan, in cells: rounding must not turn it over.
  double smallest_altitude_cells = 0;
  /// Most that it may rise, in metres per cell: what later levels' rounding moves it by must not
  /// become too much in height.
  double steepest_m = std::numeric_limits<double>::infinity();
};

/// The square of a triangle's smallest altitude over the grid, in grid units; 0 if it is folded.
double squared_altitude(GridPoint a, GridPoint b, GridPoint c);

/// Is a triangle seen from above counter-clockwise and thick enough, over the grid and, where its
/// sides are long, as the world has it?
///
/// A straight side of the world is curved over the grid: 24 km along a parallel of the 49th degree
/// lie 13 m beside it, and a sliver thinner than that can be upright there and folded here.
bool is_upright(const Place& a, const Place& b, const Place& c, double smallest_altitude_cells,
                const Placer& placer);

/// Is it upright and not too steep?
bool is_well_shaped(const Place& a, const Place& b, const Place& c, const ShapeLimits& limits,
                    const Placer& placer);

}  // namespace terrane::hierarchy

#pragma once

#include <span>
#include <vector>

#include "core/georeference.h"

namespace terrane::ingest {

/// Lays a line over the grid as FeatureLine has it: adds a point at each crossing with a column or
/// row of samples, and rounds.
///
/// \param line        at least two points, in cells.
/// \param snap_cells  points this near to a column or row of samples are moved onto it, so that no
///                    triangle becomes thinner; at most 1/4. No point moves farther than that along
///                    an axis.
/// \return empty if all of it came to lie on one point.
std::vector<GridPosition> lay_on_grid(std::span<const GridPosition> line, double snap_cells);

}  // namespace terrane::ingest

#pragma once

#include <span>
#include <vector>

#include "core/georeference.h"

namespace terrane::ingest {

/// How places of lines are rounded.
struct LineRounding {
  /// Places this near to a column or row of samples are moved onto it, so that no triangle becomes
  /// thinner; at most 1/4.
  double snap_cells = 0;
  /// Places in a cell along a row and along a column, at most kLinePartsPerCell.
  int column_parts = 1 << 14;
  int row_parts = 1 << 14;
};

/// Lays a line over the grid as FeatureLine has it: adds a point at each crossing with a column or
/// row of samples, and rounds.
///
/// No point moves farther along an axis than it is snapped or half the distance of two places.
/// \param line  at least two points, in cells.
/// \return empty if all of it came to lie on one point.
std::vector<GridPosition> lay_on_grid(std::span<const GridPosition> line,
                                      const LineRounding& rounding);

}  // namespace terrane::ingest

#pragma once

#include <span>
#include <vector>

#include "core/georeference.h"

namespace terrane::ingest {

/// Lengths on the grid of a DEM.
struct CellSize {
  double column_m = 1;  ///< distance of two samples of a row
  double row_m = 1;     ///< distance of two samples of a column
};

/// Keeps lines away from samples and from each other, so that what is joined to triangles between
/// them does not turn over when its corners are rounded.
///
/// Where a line passes a sample, or a point of any line, nearer than the gap, it is led through it;
/// where two lines cross, both get a point there. Each cell is treated by itself: no point on a
/// side of a cell comes or goes.
///
/// \param lines  as lay_on_grid() gives them, with places at least two gaps apart.
/// \param gap_m  above 0.
/// \throws InputError if lines are too tangled for that.
/// \par Source
/// Halperin and Packer 2002, Iterated snap rounding: the idea, here without pixels around points.
void separate_lines(std::span<std::vector<GridPosition>* const> lines, const CellSize& cell,
                    double gap_m);

}  // namespace terrane::ingest

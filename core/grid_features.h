#pragma once

#include <optional>
#include <vector>

#include "core/georeference.h"

namespace terrane {

/// Parts of a cell that places of lines are rounded to: exact in doubles.
inline constexpr double kLinePartsPerCell = 1 << 14;

/// A line that a terrain keeps as edges, laid over the grid of a DEM.
///
/// Its points are all places where it bends or crosses a column or row of samples, in multiples of
/// 1/kLinePartsPerCell cells, so each piece between two points lies in one closed cell. A closed
/// line ends with its first point.
struct FeatureLine {
  std::vector<GridPosition> points;
  std::optional<double> height_m;  ///< of all its points (a shore); else they lie on the terrain
};

/// Everything that a user wants kept on one DEM.
struct GridFeatures {
  std::vector<FeatureLine> lines;
  double column_m = 1;    ///< largest distance of two samples of a row, in metres
  double row_m = 1;       ///< largest distance of two samples of a column, in metres
  double off_plan_m = 0;  ///< at most this far are the lines from where their files have them
};

}  // namespace terrane

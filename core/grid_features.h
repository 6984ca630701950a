#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
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

/// Samples first to last of one row, both included, under water.
struct WaterSpan {
  std::int64_t first = 0;
  std::int64_t last = 0;
  float height_m = 0;
};

/// The samples under water, row by row. Where spans overlap, the later one tells.
using WaterRows = std::map<std::int64_t, std::vector<WaterSpan>>;

/// Everything that a user wants kept on one DEM.
struct GridFeatures {
  std::vector<FeatureLine> lines;  ///< those of shores first, body of water by body of water
  WaterRows water;
  std::vector<std::size_t> shores;  ///< of each body of water: how many of the lines are its shores
  double column_m = 1;              ///< largest distance of two samples of a row, in metres
  double row_m = 1;                 ///< largest distance of two samples of a column, in metres
  double off_plan_m = 0;    ///< at most this far are the lines from where their files have them
  std::string fingerprint;  ///< of lines and water; empty if there are none
};

}  // namespace terrane

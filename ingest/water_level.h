#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/georeference.h"
#include "core/grid_features.h"
#include "core/height_source.h"

namespace terrane::ingest {

/// A body of water on the grid: an outer shore and the shores of its islands, each laid on the grid
/// (lay_on_grid) and closed.
struct WaterBody {
  std::vector<std::vector<GridPosition>> shores;
  double height_m = 0;
};

/// Samples first to last of one row, both included.
struct RowSpan {
  std::int64_t first = 0;
  std::int64_t last = 0;
};

/// The samples of one row inside a body or exactly on its shore, from left to right. Even-odd, so
/// islands are left out.
std::vector<RowSpan> samples_inside(const WaterBody& body, std::int64_t row);

/// The median of the heights of samples inside that have a neighbour outside, or of the samples of
/// the cells that the shore touches where none is inside; the lower one of two.
/// \return nothing if all of them hold no data.
std::optional<double> shore_height_m(const WaterBody& body, const HeightSource& heights);

/// The samples of a DEM of some shape inside bodies. Later bodies win.
WaterRows water_rows(const std::vector<WaterBody>& bodies, const GridShape& shape);

/// The same DEM with every sample under water, voids too, at the water's height.
std::unique_ptr<HeightSource> level_water(std::unique_ptr<HeightSource> heights, WaterRows water);

}  // namespace terrane::ingest

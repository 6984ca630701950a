#include "tiler/dem_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/errors.h"
#include "hierarchy/mesh/grid_point.h"

namespace terrane::tiler {

static_assert(kMostCells * hierarchy::kUnitsPerCell <= std::numeric_limits<std::int32_t>::max());

void check_size(GridShape shape) {
  if (std::max(shape.columns, shape.rows) - 1 <= kMostCells) return;
  throw InputError(fmt::format(
      "the DEM has {} x {} samples, and {} along a side are the most. Cut it into parts with "
      "gdal_translate -srcwin",
      shape.columns, shape.rows, kMostCells + 1));
}

}  // namespace terrane::tiler

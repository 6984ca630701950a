#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "core/grid_features.h"

namespace terrane::tiler {

/// Where on the grid of a DEM there is water.
class WaterAreas {
 public:
  explicit WaterAreas(const GridFeatures& features);

  /// The height of the water at a place; nothing on land. Even-odd for each body, so its islands
  /// are left out. Where bodies overlap, the later one tells.
  /// \pre it lies on no shore.
  std::optional<double> height_m(const GridPosition& place) const;

 private:
  struct Side {
    GridPosition a, b;
    std::uint32_t body;
  };

  std::map<std::int64_t, std::vector<Side>> sides_;  ///< by row of cells, body by body
  std::vector<double> heights_m_;                    ///< of the bodies
};

}  // namespace terrane::tiler

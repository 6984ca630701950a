#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "core/grid_features.h"

namespace terrane::tiler {

/// Where on the grid of a DEM there is water.
class WaterAreas {
 public:
  explicit WaterAreas(const GridFeatures& features);

  /// Does a place lie in a body of water? Even-odd for each body, so its islands are left out.
  /// \pre it lies on no shore.
  bool hold(const GridPosition& place) const;

 private:
  struct Side {
    GridPosition a, b;
    std::uint32_t body;
  };

  std::map<std::int64_t, std::vector<Side>> sides_;  ///< by row of cells, body by body
};

}  // namespace terrane::tiler

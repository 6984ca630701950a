#pragma once

#include <cstdint>
#include <string>

namespace terrane {

/// What one pass over every sample of a DEM tells.
struct HeightStatistics {
  std::int64_t samples_with_data = 0;
  double min_height_m = 0;
  double max_height_m = 0;
  std::string fingerprint;  ///< 16 hex digits; equal for equal heights on an equal grid
};

}  // namespace terrane

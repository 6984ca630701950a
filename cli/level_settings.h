#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "hierarchy/levels/level_options.h"

namespace terrane::cli {

/// Where a sequence of levels ends.
struct StopRule {
  static constexpr std::uint32_t kAllLevels = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t most_levels = kAllLevels;
  std::uint32_t fewest_triangles = 0;
  std::optional<double> most_error;
};

/// Reads "level=N", "triangles=N" or "error=E". \throws ConfigError that names --stop.
StopRule stop_of(const std::string& text);

/// Reads a preset's name or "curvature,angle,valence,error".
/// \throws ConfigError that names --weights.
hierarchy::Weights weights_of(const std::string& text);

}  // namespace terrane::cli

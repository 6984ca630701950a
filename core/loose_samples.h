#pragma once

#include <vector>

#include "core/height_grid.h"

namespace terrane {

/// A height between the samples of a grid.
struct LooseSample {
  double column = 0;  ///< in cells of the grid
  double row = 0;
  double height_m = 0;
};

/// Heights that a mesh over a grid is held to besides those of the grid's own samples: where the
/// grid was resampled, the samples that it was made from.
class LooseSamples {
 public:
  virtual ~LooseSamples() = default;

  /// Those from the window's first column and row to its last ones, in a fixed order.
  ///
  /// Thread-safe. The window may reach beyond the grid: there are no samples then.
  /// \throws InputError if they cannot be read.
  virtual std::vector<LooseSample> in(const Window& window) const = 0;
};

}  // namespace terrane

#pragma once

#include "core/height_grid.h"

namespace terrane {

/// A DEM of any size, read window by window.
class HeightSource {
 public:
  virtual ~HeightSource() = default;

  /// Samples of the whole DEM; both numbers are at least 2.
  virtual GridShape shape() const = 0;

  /// Reads one window: heights in metres (unit, scale and offset applied), NaN for no data.
  ///
  /// Thread-safe. The same window gives the same bits at every call.
  /// \pre the window lies inside shape().
  /// \throws InputError if the file cannot be read there (names the file and the window).
  virtual HeightGrid read(const Window& window) const = 0;
};

}  // namespace terrane

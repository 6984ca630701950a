#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace terrane {

/// Number of samples of a whole DEM.
struct GridShape {
  std::int64_t columns = 0;
  std::int64_t rows = 0;

  bool operator==(const GridShape&) const = default;
};

/// A rectangle of samples: columns [column, column + columns), rows [row, row + rows).
/// Column 0, row 0 is the DEM's first sample (north-west for a north-up DEM).
struct Window {
  std::int64_t column = 0;
  std::int64_t row = 0;
  std::int64_t columns = 0;
  std::int64_t rows = 0;

  bool operator==(const Window&) const = default;
};

/// Height of a sample that holds no data.
inline constexpr float kNoHeight = std::numeric_limits<float>::quiet_NaN();

/// Heights of a window of a DEM, in metres, row by row; NaN where there is no data.
struct HeightGrid {
  Window window;
  std::vector<float> heights_m;  ///< window.columns * window.rows

  /// Height at a column and row of the *DEM* (not of the window).
  /// \pre the sample lies in the window.
  float at(std::int64_t column, std::int64_t row) const {
    return heights_m[static_cast<std::size_t>((row - window.row) * window.columns + column -
                                              window.column)];
  }

  bool has_data(std::int64_t column, std::int64_t row) const {
    return !std::isnan(at(column, row));
  }
};

}  // namespace terrane

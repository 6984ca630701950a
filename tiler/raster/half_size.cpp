#include "tiler/raster/half_size.h"

#include <cmath>
#include <limits>

namespace terrane::tiler {

void add_half_size(std::span<const float> tile, int side_px, bool right, bool lower,
                   std::vector<float>& coarser) {
  const auto side = static_cast<std::size_t>(side_px), half = side / 2;
  for (std::size_t row = 0; row < half; ++row) {
    for (std::size_t column = 0; column < half; ++column) {
      double sum_m = 0;
      int count = 0;
      for (const std::size_t corner : {std::size_t{0}, std::size_t{1}, side, side + 1}) {
        const float height_m = tile[2 * row * side + 2 * column + corner];
        if (std::isnan(height_m)) continue;
        sum_m += height_m;
        ++count;
      }
      coarser[(row + (lower ? half : 0)) * side + column + (right ? half : 0)] =
          count == 0 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(sum_m / count);
    }
  }
}

}  // namespace terrane::tiler

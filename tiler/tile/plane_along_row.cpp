#include "tiler/tile/plane_along_row.h"

#include <algorithm>
#include <cmath>

#include "hierarchy/collapse/lanes.h"

namespace terrane::tiler {
namespace {

constexpr std::size_t kColumnsAtOnce = 8;

/// One polynomial at several places.
TERRANE_LANES_INLINE void evaluate(const TileFrame::AlongRow& polynomial, const double* at,
                                   double* result) {
  for (std::size_t i = 0; i < kColumnsAtOnce; ++i) {
    result[i] = polynomial.coefficients[static_cast<std::size_t>(polynomial.degree)];
  }
  for (int k = polynomial.degree - 1; k >= 0; --k) {
    const double coefficient = polynomial.coefficients[static_cast<std::size_t>(k)];
    for (std::size_t i = 0; i < kColumnsAtOnce; ++i) result[i] = result[i] * at[i] + coefficient;
  }
}

}  // namespace

PlaneAlongRow::PlaneAlongRow(const TileFrame::Row& row, const Eigen::Vector3d& point,
                             const Eigen::Vector3d& normal)
    : above_(row.along_base(-normal)), up_(row.along_up(normal)) {
  above_.coefficients[0] += normal.dot(point);
}

struct PlaneAlongRow::Raising {
  const PlaneAlongRow& plane;
  std::int64_t first_column;
  std::span<const float> heights_m;
  std::span<double> worst_m;

  TERRANE_LANES_INLINE bool run() const {
    for (std::size_t first = 0; first < heights_m.size(); first += kColumnsAtOnce) {
      double at[kColumnsAtOnce], above[kColumnsAtOnce], up[kColumnsAtOnce];
      const auto column = static_cast<double>(first_column + static_cast<std::int64_t>(first));
      for (std::size_t i = 0; i < kColumnsAtOnce; ++i) {
        at[i] = (column + static_cast<double>(i)) * plane.up_.per_column - 1;
      }
      evaluate(plane.above_, at, above);
      evaluate(plane.up_, at, up);
      const std::size_t count = std::min(kColumnsAtOnce, heights_m.size() - first);
      const float* heights = heights_m.data() + first;
      double* worst = worst_m.data() + first;
      if (count == kColumnsAtOnce) {
        for (std::size_t i = 0; i < kColumnsAtOnce; ++i) {
          const double error_m = std::abs(above[i] / up[i] - double{heights[i]});
          worst[i] = error_m > worst[i] ? error_m : worst[i];
        }
      } else {
        for (std::size_t i = 0; i < count; ++i) {
          const double error_m = std::abs(above[i] / up[i] - double{heights[i]});
          worst[i] = error_m > worst[i] ? error_m : worst[i];
        }
      }
    }
    return true;
  }
};

void PlaneAlongRow::raise_errors(std::int64_t first_column, std::span<const float> heights_m,
                                 std::span<double> worst_m) const {
  const Raising raising{*this, first_column, heights_m, worst_m};
  if (hierarchy::has_wide_lanes()) {
    hierarchy::run_wide(raising);
  } else {
    hierarchy::run_portable(raising);
  }
}

}  // namespace terrane::tiler

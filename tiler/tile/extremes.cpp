#include "tiler/tile/extremes.h"

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "hierarchy/collapse/lanes.h"

namespace terrane::tiler {
namespace {

using hierarchy::FieldSample;
using hierarchy::HalfLanes;
using hierarchy::HalfMask;

constexpr std::int64_t kColumnsAtOnce = hierarchy::kLanes / 2;

bool is_same(const FieldSample& a, const FieldSample& b) {
  return a.row == b.row && a.column == b.column;
}

/// The heights of a window, NaN where there is none; its first sample is (0, 0).
struct WindowHeights {
  GridShape shape;
  std::vector<double> heights_m;

  WindowHeights(const DatumHeights& heights, const Window& window)
      : shape{window.columns, window.rows} {
    heights_m.reserve(static_cast<std::size_t>(shape.columns * shape.rows));
    for (std::int64_t row = 0; row < shape.rows; ++row) {
      for (std::int64_t column = 0; column < shape.columns; ++column) {
        heights_m.push_back(heights.at(window.column + column, window.row + row));
      }
    }
  }
  const double* row(std::int64_t r) const { return heights_m.data() + r * shape.columns; }
};

/// A plane over a window.
struct Plane {
  double constant, per_column, per_row;
};

/// The least-squares plane; where fewer than three samples span one, one of those through them.
Plane plane_along(const WindowHeights& heights) {
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sums = Eigen::Vector3d::Zero();
  for (std::int64_t row = 0; row < heights.shape.rows; ++row) {
    const auto y = static_cast<double>(row);
    double count = 0, xs = 0, squares = 0;
    for (std::int64_t column = 0; column < heights.shape.columns; ++column) {
      const double z = heights.row(row)[column];
      if (std::isnan(z)) continue;
      const auto x = static_cast<double>(column);
      count += 1;
      xs += x;
      squares += x * x;
      sums += Eigen::Vector3d(z, z * x, z * y);
    }
    products += Eigen::Matrix3d{
        {count, xs, count * y}, {xs, squares, xs * y}, {count * y, xs * y, count * y * y}};
  }
  const Eigen::Vector3d terms = products.completeOrthogonalDecomposition().solve(sums);
  return {terms[0], terms[1], terms[2]};
}

/// How far one sample sticks out, and its number in the window, row by row.
struct Outlier {
  double by_m = -std::numeric_limits<double>::infinity();
  std::int64_t sample = 0;
};

/// Of those at the same place in each four columns, the one that sticks out most on one side.
struct OutlierLanes {
  HalfLanes by_m = HalfLanes{} + Outlier{}.by_m;
  HalfLanes sample{};

  TERRANE_LANES_INLINE void add(const HalfLanes& sticks_out_m, const HalfLanes& samples) {
    // false for samples without a height
    const HalfMask is_farther = sticks_out_m > by_m;
    by_m = is_farther ? sticks_out_m : by_m;
    sample = is_farther ? samples : sample;
  }
};

/// The first of those that stick out most.
TERRANE_LANES_INLINE Outlier most_of(const OutlierLanes& a, const OutlierLanes& b) {
  const HalfMask is_b = (b.by_m > a.by_m) | ((b.by_m == a.by_m) & (b.sample < a.sample));
  const HalfLanes by_m = is_b ? b.by_m : a.by_m, sample = is_b ? b.sample : a.sample;
  std::size_t most = 0;
  for (std::size_t i = 1; i < kColumnsAtOnce; ++i) {
    const bool is_before = by_m[i] == by_m[most] && sample[i] < sample[most];
    if (by_m[i] > by_m[most] || is_before) most = i;
  }
  return {by_m[most], static_cast<std::int64_t>(sample[most])};
}

struct Outliers {
  Outlier above, below;
};

/// What sticks out most above and below a plane in a part of a window.
struct PartOutliers {
  const WindowHeights& heights;
  const Plane& plane;
  const Window& part;

  TERRANE_LANES_INLINE Outliers run() const {
    // rows by turns: what one waits for is then not what the one before does
    std::array<OutlierLanes, 2> above, below;
    for (std::int64_t first = 0; first < part.columns; first += kColumnsAtOnce) {
      const auto columns = static_cast<double>(part.column + first) + HalfLanes{0, 1, 2, 3};
      const HalfLanes along_row_m = plane.constant + plane.per_column * columns;
      const bool is_cut_off = part.columns - first < kColumnsAtOnce;
      for (std::int64_t row = 0; row < part.rows; ++row) {
        const double* const from = heights.row(part.row + row) + part.column + first;
        const HalfLanes z = is_cut_off ? load_some(from, part.columns - first) : load(from);
        const HalfLanes over_m =
            z - (along_row_m + plane.per_row * static_cast<double>(part.row + row));
        const HalfLanes samples =
            columns + static_cast<double>((part.row + row) * heights.shape.columns);
        above[row & 1].add(over_m, samples);
        below[row & 1].add(-over_m, samples);
      }
    }
    return {most_of(above[0], above[1]), most_of(below[0], below[1])};
  }

 private:
  TERRANE_LANES_INLINE static HalfLanes load(const double* from) {
    HalfLanes lanes;
    std::memcpy(&lanes, from, sizeof lanes);
    return lanes;
  }
  TERRANE_LANES_INLINE static HalfLanes load_some(const double* from, std::int64_t count) {
    HalfLanes lanes = HalfLanes{} + std::numeric_limits<double>::quiet_NaN();
    for (std::int64_t i = 0; i < count; ++i) lanes[i] = from[i];
    return lanes;
  }
};

Outliers outliers_of(const WindowHeights& heights, const Plane& plane, const Window& part) {
  const PartOutliers outliers{heights, plane, part};
  return hierarchy::has_wide_lanes() ? hierarchy::run_wide(outliers)
                                     : hierarchy::run_portable(outliers);
}

constexpr std::size_t kPlanes = kExtremesPerPart / 2;

/// The trend, and the same tilted to each side as steeply as the terrain departs from it: whatever
/// plane a mesh has there, what sticks out most of it sticks out of one of these about as much.
std::array<Plane, kPlanes> tilted_planes(const WindowHeights& heights) {
  const auto [columns, rows] = heights.shape;
  const Plane trend = plane_along(heights);
  const Outliers most = outliers_of(heights, trend, {0, 0, columns, rows});
  const double tilt = (std::max(0.0, most.above.by_m) + std::max(0.0, most.below.by_m)) /
                      static_cast<double>(std::max(columns, rows));
  constexpr double kSides[kPlanes][2] = {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  std::array<Plane, kPlanes> planes;
  for (std::size_t k = 0; k < kPlanes; ++k) {
    planes[k] = trend;
    planes[k].per_column += kSides[k][0] * tilt;
    planes[k].per_row += kSides[k][1] * tilt;
  }
  return planes;
}

}  // namespace

void add_extremes(const DatumHeights& heights, const Window& around, std::int64_t part_cells,
                  std::vector<FieldSample>& result) {
  const WindowHeights of_window(heights, around);
  const std::array<Plane, kPlanes> planes = tilted_planes(of_window);
  const auto sample_of = [&](const Outlier& outlier) {
    const std::int64_t column = outlier.sample % around.columns;
    const std::int64_t row = outlier.sample / around.columns;
    return FieldSample{static_cast<float>(around.column - heights.tile.column + column),
                       static_cast<float>(around.row - heights.tile.row + row),
                       of_window.row(row)[column]};
  };
  for_each_part({0, 0, around.columns, around.rows}, part_cells, [&](const Window& part) {
    const auto first = static_cast<std::ptrdiff_t>(result.size());
    for (const Plane& plane : planes) {
      const Outliers outliers = outliers_of(of_window, plane, part);
      if (outliers.above.by_m == Outlier{}.by_m) return;
      for (const Outlier& outlier : {outliers.above, outliers.below}) {
        const FieldSample sample = sample_of(outlier);
        const auto begin = result.begin() + first;
        if (std::none_of(begin, result.end(),
                         [&](const FieldSample& s) { return is_same(s, sample); })) {
          result.push_back(sample);
        }
      }
    }
  });
}

}  // namespace terrane::tiler

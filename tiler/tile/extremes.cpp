#include "tiler/tile/extremes.h"

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>

namespace terrane::tiler {
namespace {

using hierarchy::FieldSample;

bool is_same(const FieldSample& a, const FieldSample& b) {
  return a.row == b.row && a.column == b.column;
}

/// Sums for the least-squares trend.
class TrendPlane {
 public:
  void add(double x, double y, double z) {
    const Eigen::Vector3d terms(1, x, y);
    products_ += terms * terms.transpose();
    heights_ += z * terms;
  }

  /// Where fewer than three samples span a plane, one of those through them.
  Eigen::Vector3d solve() const {
    return products_.completeOrthogonalDecomposition().solve(heights_);
  }

 private:
  Eigen::Matrix3d products_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d heights_ = Eigen::Vector3d::Zero();
};

/// A plane over some block, from a corner of its trend on.
struct Plane {
  double constant, per_column, per_row;
  double above_m(double x, double y, double z) const {
    return z - (constant + per_column * x + per_row * y);
  }
};

/// The trend, and the same tilted to each side as steeply as the terrain departs from it: whatever
/// plane a mesh has there, what sticks out most of it sticks out of one of these about as much.
class Trends {
 public:
  static constexpr std::size_t kCount = kExtremesPerPart / 2;

  Trends(const Window& around, const DatumHeights& heights)
      : x0_(static_cast<double>(around.column - heights.tile.column)),
        y0_(static_cast<double>(around.row - heights.tile.row)) {
    TrendPlane fitted;
    heights.for_each(around,
                     [&](double x, double y, double z) { fitted.add(x - x0_, y - y0_, z); });
    const Eigen::Vector3d terms = fitted.solve();
    const Plane trend{terms[0], terms[1], terms[2]};
    double highest_m = 0, lowest_m = 0;
    heights.for_each(around, [&](double x, double y, double z) {
      const double above_m = trend.above_m(x - x0_, y - y0_, z);
      highest_m = std::max(highest_m, above_m);
      lowest_m = std::min(lowest_m, above_m);
    });
    const double tilt =
        (highest_m - lowest_m) / static_cast<double>(std::max(around.columns, around.rows));
    constexpr double kSides[kCount][2] = {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    for (std::size_t k = 0; k < kCount; ++k) {
      planes_[k] = trend;
      planes_[k].per_column += kSides[k][0] * tilt;
      planes_[k].per_row += kSides[k][1] * tilt;
    }
  }

  double above_m(std::size_t k, double x, double y, double z) const {
    return planes_[k].above_m(x - x0_, y - y0_, z);
  }

 private:
  double x0_, y0_;
  std::array<Plane, kCount> planes_;
};

/// A sample, and how far it sticks out.
struct Extreme {
  double by_m = -INFINITY;
  FieldSample sample;
};

}  // namespace

void add_extremes(const DatumHeights& heights, const Window& around, std::int64_t part_cells,
                  std::vector<FieldSample>& result) {
  const Trends trends(around, heights);
  for_each_part(around, part_cells, [&](const Window& part) {
    std::array<Extreme, kExtremesPerPart> extremes;
    heights.for_each(part, [&](double x, double y, double z) {
      const FieldSample sample{static_cast<float>(x), static_cast<float>(y), z};
      for (std::size_t k = 0; k < Trends::kCount; ++k) {
        const double above_m = trends.above_m(k, x, y, z);
        if (above_m > extremes[2 * k].by_m) extremes[2 * k] = {above_m, sample};
        if (-above_m > extremes[2 * k + 1].by_m) extremes[2 * k + 1] = {-above_m, sample};
      }
    });
    if (extremes[0].by_m == -INFINITY) return;
    const auto first = static_cast<std::ptrdiff_t>(result.size());
    for (const Extreme& extreme : extremes) {
      const auto begin = result.begin() + first;
      if (std::none_of(begin, result.end(),
                       [&](const FieldSample& s) { return is_same(s, extreme.sample); })) {
        result.push_back(extreme.sample);
      }
    }
  });
}

}  // namespace terrane::tiler

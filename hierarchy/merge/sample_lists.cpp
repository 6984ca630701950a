#include "hierarchy/merge/sample_lists.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hierarchy/levels/level_error.h"

namespace terrane::hierarchy {
namespace {

double cross(const Eigen::Vector3d& o, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
}

SampleError vertical_error(const Eigen::Vector3d& s, std::span<const TrianglePlaces> fan) {
  SampleError result;
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < fan.size(); ++i) {
    const auto& [a, b, c] = fan[i];
    const double wa = cross(s, b, c), wb = cross(s, c, a), wc = cross(s, a, b);
    // exact: 0 or more for the triangle that covers the sample, on its border, too
    const double least = std::min({wa, wb, wc});
    if (least <= best) continue;
    best = least;
    const double height = (wa * a.z() + wb * b.z() + wc * c.z()) / (wa + wb + wc);
    result = {std::abs(height - s.z()), i};
    if (least >= 0) break;
  }
  return result;
}

SampleError distance_error(const Eigen::Vector3d& s, std::span<const TrianglePlaces> fan) {
  SampleError result{.error = std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < fan.size(); ++i) {
    const double squared = squared_distance(s, fan[i][0], fan[i][1], fan[i][2]);
    if (squared < result.error) result = {squared, i};
  }
  result.error = std::sqrt(result.error);
  return result;
}

}  // namespace

SampleError sample_error(ErrorMeasure measure, const Eigen::Vector3d& sample,
                         std::span<const TrianglePlaces> fan) {
  return measure == ErrorMeasure::kVertical ? vertical_error(sample, fan)
                                            : distance_error(sample, fan);
}

}  // namespace terrane::hierarchy

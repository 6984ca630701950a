#include "hierarchy/merge/view_ranges.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hierarchy/merge/merge_tree.h"

namespace terrane::hierarchy {
namespace {

ViewRanges::Ranges ranges(float error, float switched, float radius, float angle, float colour) {
  // wider than the tangent loses as a float
  const double wide = std::min(angle + 1e-6, std::numbers::pi);
  return {error, switched, radius, static_cast<float>(std::tan(wide / 2)), colour};
}

}  // namespace

std::vector<ViewRanges> view_ranges_of(const MergeTree& tree) {
  std::vector<ViewRanges> result(tree.merge_count());
  for (std::uint32_t i = 0; i < tree.merge_count(); ++i) {
    const MergeBounds& b = tree.bounds[i];
    const std::uint32_t centre = tree.centre(i);
    const Eigen::Vector3f place = tree.place(centre);
    const Eigen::Vector3f& axis = tree.normals[centre];
    result[i] = {
        .place = {place.x(), place.y(), place.z()},
        .axis = {axis.x(), axis.y(), axis.z()},
        .own = ranges(b.error, b.switched, b.radius, b.angle, b.colour),
        .all = ranges(b.all_error, b.all_switched, b.all_radius, b.all_angle, b.all_colour)};
  }
  return result;
}

}  // namespace terrane::hierarchy

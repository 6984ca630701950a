#include "hierarchy/merge/measure_bounds.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "hierarchy/merge/normal_code.h"
#include "hierarchy/merge/sample_lists.h"
#include "hierarchy/merge/surface_normals.h"

namespace terrane::hierarchy {
namespace {

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Works from the finest merge to the coarsest.
class BoundsMeter {
 public:
  explicit BoundsMeter(MergeTree& tree);
  void run();

 private:
  void set_normals();
  void measure(std::uint32_t i);
  void gather(std::uint32_t i);
  double hand_over(std::uint32_t i);
  void measure_ranges(std::uint32_t i, MergeBounds& bounds) const;
  double switch_distance(std::uint32_t i);
  void join_finer(std::uint32_t i, MergeBounds& bounds) const;
  TrianglePlaces places(std::uint32_t t) const;

  MergeTree& tree_;
  std::vector<Eigen::Vector3d> points_, normals_;
  std::vector<bool> is_full_;     // vertices of the full mesh
  std::vector<double> switched_;  // largest switch distance below each vertex
  SampleLists lists_;
  std::vector<std::uint32_t> samples_, corners_;  // of the merge at hand
  std::vector<TrianglePlaces> fan_;
};

BoundsMeter::BoundsMeter(MergeTree& tree)
    : tree_(tree),
      is_full_(tree.points.size(), true),
      switched_(tree.points.size(), 0),
      lists_(tree.points.size(), tree.triangles.size()) {
  for (const Eigen::Vector3i& p : tree.points) points_.push_back(tree.lattice.relative(p));
  for (const Merge& merge : tree.merges) {
    if (merge.child_count == 3) is_full_[merge.parent] = false;
  }
}

void BoundsMeter::set_normals() {
  std::vector<Corners> full;
  const std::vector<bool> is_full = full_triangles(tree_);
  for (std::size_t t = 0; t < is_full.size(); ++t) {
    if (is_full[t]) full.push_back(tree_.triangles[t]);
  }
  normals_ = vertex_normals(points_, full);
  for (std::uint32_t i = tree_.merge_count(); i-- > 0;) {
    const Merge& merge = tree_.merges[i];
    if (merge.child_count != 3) continue;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::uint32_t k = 0; k < 3; ++k) sum += normals_[merge.first_child + k];
    const double length = sum.norm();
    normals_[merge.parent] = length > 0 ? Eigen::Vector3d(sum / length) : Eigen::Vector3d::UnitZ();
  }
  tree_.normals.clear();
  for (Eigen::Vector3d& n : normals_) {
    tree_.normals.push_back(decoded_normal(encoded_normal(n)));
    n = tree_.normals.back().cast<double>();
  }
}

TrianglePlaces BoundsMeter::places(std::uint32_t t) const {
  const Corners& c = tree_.triangles[t];
  return {points_[c[0]], points_[c[1]], points_[c[2]]};
}

/// The samples and the corners of the triangles that the merge replaces.
void BoundsMeter::gather(std::uint32_t i) {
  const Merge& merge = tree_.merges[i];
  samples_.clear();
  corners_.clear();
  for (std::uint32_t t = merge.fine_begin; t < merge.fine_end; ++t) {
    lists_.append_to(samples_, t);
    for (const std::uint32_t v : tree_.triangles[t]) corners_.push_back(v);
  }
  for (std::uint32_t k = 0; k < merge.child_count; ++k) {
    const std::uint32_t child = merge.first_child + k;
    if (is_full_[child]) samples_.push_back(child);
  }
  if (merge.child_count == 3) corners_.push_back(merge.parent);
  std::ranges::sort(corners_);
  const auto rest = std::ranges::unique(corners_);
  corners_.erase(rest.begin(), rest.end());
}

/// Gives the samples to the triangles that come; the largest error.
double BoundsMeter::hand_over(std::uint32_t i) {
  fan_.clear();
  for (const std::uint32_t t : tree_.coarse(i)) fan_.push_back(places(t));
  double largest = 0;
  for (const std::uint32_t s : samples_) {
    const SampleError error = sample_error(tree_.measure, points_[s], fan_);
    largest = std::max(largest, error.error);
    lists_.add(s, tree_.coarse(i)[error.triangle]);
  }
  return largest;
}

void BoundsMeter::measure_ranges(std::uint32_t i, MergeBounds& bounds) const {
  const std::uint32_t centre = tree_.centre(i);
  const Eigen::Vector3d& axis = normals_[centre];
  double radius = 0, angle = 0;
  Colour low{255, 255, 255}, high{0, 0, 0};
  const auto take = [&](std::uint32_t v) {
    for (std::size_t k = 0; k < 3 && !tree_.colours.empty(); ++k) {
      low[k] = std::min(low[k], tree_.colours[v][k]);
      high[k] = std::max(high[k], tree_.colours[v][k]);
    }
    radius = std::max(radius, (points_[v] - points_[centre]).norm());
    angle = std::max(angle, angle_between(axis, normals_[v]));
  };
  std::ranges::for_each(corners_, take);
  std::ranges::for_each(samples_, take);
  const auto take_face = [&](std::uint32_t t) {
    const auto [a, b, c] = places(t);
    const Eigen::Vector3d area = (b - a).cross(c - a);
    if (area.squaredNorm() > 0) angle = std::max(angle, angle_between(axis, area));
  };
  for (const std::uint32_t t : tree_.coarse(i)) take_face(t);
  for (std::uint32_t t = tree_.merges[i].fine_begin; t < tree_.merges[i].fine_end; ++t)
    take_face(t);
  bounds.radius = rounded_up(radius);
  bounds.angle = rounded_up(angle);
  int range = 0;
  for (std::size_t k = 0; k < 3; ++k) range = std::max(range, high[k] - low[k]);
  bounds.colour = rounded_up(range / 255.0);
}

double BoundsMeter::switch_distance(std::uint32_t i) {
  const Merge& merge = tree_.merges[i];
  double distance = 0;
  for (std::uint32_t k = 0; k < merge.child_count; ++k) {
    const std::uint32_t child = merge.first_child + k;
    distance =
        std::max({distance, switched_[child], (points_[child] - points_[merge.parent]).norm()});
  }
  switched_[merge.parent] = std::max(switched_[merge.parent], distance);
  return distance;
}

void BoundsMeter::join_finer(std::uint32_t i, MergeBounds& bounds) const {
  const std::uint32_t centre = tree_.centre(i);
  double radius = bounds.radius, angle = bounds.angle;
  bounds.all_error = bounds.error;
  bounds.all_switched = bounds.switched;
  bounds.all_colour = bounds.colour;
  for (const std::uint32_t f : tree_.finer(i)) {
    const MergeBounds& below = tree_.bounds[f];
    const std::uint32_t other = tree_.centre(f);
    bounds.all_error = std::max(bounds.all_error, below.all_error);
    bounds.all_switched = std::max(bounds.all_switched, below.all_switched);
    bounds.all_colour = std::max(bounds.all_colour, below.all_colour);
    radius = std::max(radius, (points_[other] - points_[centre]).norm() + below.all_radius);
    angle = std::max(angle, angle_between(normals_[centre], normals_[other]) + below.all_angle);
  }
  bounds.all_radius = rounded_up(radius);
  bounds.all_angle = rounded_up(std::min(angle, std::numbers::pi));
}

void BoundsMeter::measure(std::uint32_t i) {
  MergeBounds& bounds = tree_.bounds[i];
  gather(i);
  bounds.error = rounded_up(hand_over(i));
  bounds.switched = rounded_up(switch_distance(i));
  measure_ranges(i, bounds);
  join_finer(i, bounds);
}

void BoundsMeter::run() {
  set_normals();
  tree_.bounds.assign(tree_.merges.size(), {});
  for (std::uint32_t i = tree_.merge_count(); i-- > 0;) measure(i);
}

}  // namespace

void measure_bounds(MergeTree& tree) {
  BoundsMeter(tree).run();
  tree.view_ranges = view_ranges_of(tree);
}

float rounded_up(double value) {
  auto nearest = static_cast<float>(value);
  if (nearest < value) nearest = std::nextafter(nearest, std::numeric_limits<float>::infinity());
  const auto bits = std::bit_cast<std::uint32_t>(nearest);
  return std::bit_cast<float>((bits + 0xffffU) & 0xffff0000U);
}

}  // namespace terrane::hierarchy

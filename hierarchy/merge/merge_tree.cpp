#include "hierarchy/merge/merge_tree.h"

namespace terrane::hierarchy {

std::uint32_t MergeTree::level_count() const { return merges.empty() ? 0 : merges.front().level; }

std::uint32_t MergeTree::full_triangle_count() const {
  return static_cast<std::uint32_t>(triangles.size() - coarse_triangles.size());
}

std::uint32_t MergeTree::full_point_count() const {
  auto count = static_cast<std::uint32_t>(points.size());
  for (const Merge& merge : merges) count -= merge.child_count == 3;
  return count;
}

TreeExtent extent_of(const MergeTree& tree) {
  if (tree.points.empty()) return {Eigen::Vector3d::Zero(), 0};
  Eigen::Vector3i low = tree.points.front(), high = low;
  for (const Eigen::Vector3i& p : tree.points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Eigen::Vector3d a = tree.lattice.relative(low), b = tree.lattice.relative(high);
  return {(a + b) / 2, (b - a).norm() / 2};
}

std::vector<bool> full_triangles(const MergeTree& tree) {
  std::vector<bool> is_full(tree.triangles.size(), true);
  for (const std::uint32_t t : tree.coarse_triangles) is_full[t] = false;
  return is_full;
}

}  // namespace terrane::hierarchy

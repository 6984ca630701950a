#include "hierarchy/merge/display_mesh.h"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace terrane::hierarchy {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

std::vector<ChangedRange> ranges_of(std::vector<std::uint32_t> changed, std::uint32_t size,
                                    std::uint32_t gap) {
  std::sort(changed.begin(), changed.end());
  std::vector<ChangedRange> ranges;
  for (const std::uint32_t i : changed) {
    if (i >= size) break;
    if (!ranges.empty() && i <= ranges.back().end + gap) {
      ranges.back().end = std::max(ranges.back().end, i + 1);
    } else {
      ranges.push_back({i, i + 1});
    }
  }
  return ranges;
}

}  // namespace

DisplayMesh::DisplayMesh(const MergeTree& tree)
    : tree_(tree), triangle_at_(tree.triangles.size(), kNone), slot_(tree.points.size(), kNone) {
  for (std::uint32_t v = 0; v < tree.coarsest_points; ++v) show_vertex(v);
  scratch_.resize(tree.coarsest_triangles);
  std::iota(scratch_.begin(), scratch_.end(), 0U);
  replace({}, scratch_);
}

void DisplayMesh::show_vertex(std::uint32_t vertex) {
  std::uint32_t slot = static_cast<std::uint32_t>(positions_.size() / 3);
  if (free_slots_.empty()) {
    positions_.resize(positions_.size() + 3);
    normals_.resize(normals_.size() + 3);
    if (!tree_.colours.empty()) colours_.resize(colours_.size() + 4, 255);
  } else {
    slot = free_slots_.back();
    free_slots_.pop_back();
  }
  slot_[vertex] = slot;
  ++vertex_count_;
  const Eigen::Vector3f& n = tree_.normals[vertex];
  std::copy_n(n.data(), 3, normals_.begin() + std::ptrdiff_t(3) * slot);
  if (!tree_.colours.empty()) {
    std::copy_n(tree_.colours[vertex].begin(), 3, colours_.begin() + std::ptrdiff_t(4) * slot);
  }
  move(vertex, tree_.place(vertex));
}

void DisplayMesh::hide_vertex(std::uint32_t vertex) {
  free_slots_.push_back(slot_[vertex]);
  slot_[vertex] = kNone;
  --vertex_count_;
}

void DisplayMesh::move(std::uint32_t vertex, const Eigen::Vector3f& place) {
  const std::uint32_t slot = slot_[vertex];
  assert(slot != kNone);
  std::copy_n(place.data(), 3, positions_.begin() + std::ptrdiff_t(3) * slot);
  changed_slots_.push_back(slot);
}

void DisplayMesh::write(std::uint32_t at, std::uint32_t triangle) {
  shown_[at] = triangle;
  triangle_at_[triangle] = at;
  for (std::size_t k = 0; k < 3; ++k) {
    indices_[3 * std::size_t{at} + k] = slot_[tree_.triangles[triangle][k]];
  }
  changed_triangles_.push_back(at);
}

/// Writes those that come over those that go; what is left over goes to or comes from the end.
void DisplayMesh::replace(std::span<const std::uint32_t> gone,
                          std::span<const std::uint32_t> come) {
  const std::size_t both = std::min(gone.size(), come.size());
  for (std::size_t i = 0; i < both; ++i) {
    const std::uint32_t at = triangle_at_[gone[i]];
    triangle_at_[gone[i]] = kNone;
    write(at, come[i]);
  }
  for (std::size_t i = both; i < come.size(); ++i) {
    shown_.push_back(0);
    indices_.resize(indices_.size() + 3);
    write(triangle_count() - 1, come[i]);
  }
  for (std::size_t i = both; i < gone.size(); ++i) {
    const std::uint32_t at = triangle_at_[gone[i]];
    triangle_at_[gone[i]] = kNone;
    const std::uint32_t last = shown_.back();
    if (at + 1 != shown_.size()) write(at, last);
    shown_.pop_back();
    indices_.resize(indices_.size() - 3);
  }
}

void DisplayMesh::split(std::uint32_t merge) {
  const Merge& m = tree_.merges[merge];
  for (std::uint32_t k = 0; k < m.child_count; ++k) show_vertex(m.first_child + k);
  scratch_.resize(m.fine_end - m.fine_begin);
  std::iota(scratch_.begin(), scratch_.end(), m.fine_begin);
  replace(tree_.coarse(merge), scratch_);
  if (m.child_count == 3) hide_vertex(m.parent);
}

void DisplayMesh::merge(std::uint32_t merge) {
  const Merge& m = tree_.merges[merge];
  if (m.child_count == 3) show_vertex(m.parent);
  scratch_.resize(m.fine_end - m.fine_begin);
  std::iota(scratch_.begin(), scratch_.end(), m.fine_begin);
  replace(scratch_, tree_.coarse(merge));
  for (std::uint32_t k = 0; k < m.child_count; ++k) hide_vertex(m.first_child + k);
}

std::vector<ChangedRange> DisplayMesh::changed_triangles(std::uint32_t gap) const {
  return ranges_of(changed_triangles_, triangle_count(), gap);
}

std::vector<ChangedRange> DisplayMesh::changed_vertices(std::uint32_t gap) const {
  return ranges_of(changed_slots_, static_cast<std::uint32_t>(positions_.size() / 3), gap);
}

void DisplayMesh::forget_changes() {
  changed_triangles_.clear();
  changed_slots_.clear();
}

}  // namespace terrane::hierarchy

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/merge/merge_tree.h"

namespace terrane::hierarchy {

/// Elements begin ... end - 1 of an array.
struct ChangedRange {
  std::uint32_t begin = 0, end = 0;
  bool operator==(const ChangedRange&) const = default;
};

/// The triangles and vertices that show, in arrays as a GPU draws them, changed in place.
///
/// Triangles are packed: the first triangle_count() of indices() are all that show, in no order.
/// Vertices have slots that they keep while they show; slots that are free hold old places and
/// are named by no triangle.
class DisplayMesh {
 public:
  /// Shows the coarsest mesh. \param tree  must outlive the display.
  explicit DisplayMesh(const MergeTree& tree);

  void split(std::uint32_t merge);
  void merge(std::uint32_t merge);
  /// Moves a vertex that shows.
  void move(std::uint32_t vertex, const Eigen::Vector3f& place);

  std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(shown_.size()); }
  std::uint32_t vertex_count() const { return vertex_count_; }
  /// Three slots for each triangle.
  const std::vector<std::uint32_t>& indices() const { return indices_; }
  /// Three floats for each slot, relative to the lattice's origin.
  const std::vector<float>& positions() const { return positions_; }
  const std::vector<float>& normals() const { return normals_; }
  /// Four bytes for each slot, the last one 255; empty if the tree has no colours.
  const std::vector<std::uint8_t>& colours() const { return colours_; }

  /// Ids of the triangles that show; as many as triangle_count().
  const std::vector<std::uint32_t>& shown() const { return shown_; }

  /// Triangles and slots written since the last forget_changes(): ascending, not touching.
  /// \param gap  ranges so near to each other are joined: one upload costs more than a few bytes.
  std::vector<ChangedRange> changed_triangles(std::uint32_t gap = 16) const;
  std::vector<ChangedRange> changed_vertices(std::uint32_t gap = 16) const;
  void forget_changes();

 private:
  void replace(std::span<const std::uint32_t> gone, std::span<const std::uint32_t> come);
  void write(std::uint32_t at, std::uint32_t triangle);
  void show_vertex(std::uint32_t vertex);
  void hide_vertex(std::uint32_t vertex);

  const MergeTree& tree_;
  std::vector<std::uint32_t> indices_;
  std::vector<float> positions_, normals_;
  std::vector<std::uint8_t> colours_;
  std::vector<std::uint32_t> shown_;        // id of each triangle of indices_
  std::vector<std::uint32_t> triangle_at_;  // place in shown_, by id
  std::vector<std::uint32_t> slot_;         // by vertex
  std::vector<std::uint32_t> free_slots_;
  std::vector<std::uint32_t> changed_triangles_, changed_slots_;
  std::vector<std::uint32_t> scratch_;
  std::uint32_t vertex_count_ = 0;
};

}  // namespace terrane::hierarchy

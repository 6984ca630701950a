#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/merge/merge_tree.h"

namespace terrane::hierarchy {

/// The way back from one collapse. Vertices have their numbers in the tree.
///
/// The triangles about the parent are dealt out counter-clockwise: for an edge those from apex 0 to
/// apex 1 go to c, the others stay; for a triangle those from apex k to apex k + 1 go to corner
/// k + 1, as in Collapse (hierarchy/levels/level_sequence.h).
struct Split {
  std::uint32_t parent = 0;
  std::uint32_t child_count = 1;            ///< 1: an edge, 3: a triangle
  std::array<std::uint32_t, 3> apexes{};    ///< two for an edge; kOutside beyond the border
  std::array<Eigen::Vector3i, 3> places{};  ///< of the children, in lattice steps
  std::uint32_t level = 1;                  ///< of the collapse; never grows from split to split
};

/// Grows a merge tree from the coarsest mesh, split by split.
///
/// Checks all that makes a tree safe to use, so that it may be fed with anything: every split
/// finds its triangles, and depends on coarser levels alone.
class TreeGrower {
 public:
  /// \param tree  lattice, measure, region, and points and triangles of the coarsest mesh.
  /// \throws InputError if a triangle names a point that is not there, or repeats one.
  explicit TreeGrower(MergeTree tree);

  /// Neighbours of a vertex that shows, counter-clockwise: from the first one after the outside if
  /// it is on the border, else from the one with the smallest number.
  /// \throws InputError if they make no fan.
  std::vector<std::uint32_t> ring(std::uint32_t vertex) const;

  /// \throws InputError if the split does not fit the mesh that has grown so far.
  void split(const Split& split);

  const MergeTree& tree() const { return tree_; }
  /// The tree, its dependencies sorted, without bounds and normals.
  MergeTree finish() &&;

 private:
  struct RingEdge {
    std::uint32_t from, to, triangle;
  };
  std::vector<RingEdge> ring_edges(std::uint32_t vertex) const;
  std::vector<RingEdge> closed_ring(std::uint32_t vertex) const;
  void check(const Split& split) const;
  void choose_owners(const Split& split, std::span<const std::uint32_t> corners);
  void replace_triangles(std::uint32_t parent);
  void add_triangle(const Corners& corners);
  void remove_from(std::uint32_t vertex, std::uint32_t triangle);
  void depend_on_triangle(std::uint32_t triangle);
  void remember_reader(std::uint32_t triangle);
  void end_dependencies(std::uint32_t level);

  MergeTree tree_;
  std::vector<std::vector<std::uint32_t>> incident_;  // triangles that show, of each vertex
  std::vector<std::uint32_t> maker_;                  // split that each triangle came with
  struct Reader {
    std::uint32_t split, next;
  };
  std::vector<Reader> readers_;              // splits that need a triangle, as lists
  std::vector<std::uint32_t> first_reader_;  // by triangle; used for Region::kBothEnds alone
  std::vector<RingEdge> ring_;               // of the parent, and who owns each of its triangles
  std::vector<std::uint32_t> owners_;
  std::vector<std::uint32_t> needed_;
};

}  // namespace terrane::hierarchy

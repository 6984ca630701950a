#pragma once

#include <cstdint>
#include <functional>

#include "hierarchy/levels/level_sequence.h"
#include "hierarchy/levels/surface_mesh.h"
#include "hierarchy/merge/merge_tree.h"

namespace terrane::hierarchy {

/// Which edges collapse first.
enum class CollapseOrder : std::uint8_t {
  kLength,  ///< the shortest, as published
  kError,   ///< those that leave the smallest error
};

/// What happened in one pass over the mesh.
struct PassStatistics {
  std::uint32_t level = 0;  ///< of the merges that it made; 1 is the first
  std::uint32_t collapses = 0;
  std::uint32_t vertices = 0;  ///< left
};

struct MergeTreeOptions {
  CollapseOrder order = CollapseOrder::kError;
  Region region = Region::kRemovedEnd;
  /// Share of the vertices (kLength: edges) that could go, cheapest first, that a pass looks at; in
  /// (0, 1]. Less than 1 leaves the most expensive ones of each pass for later ones: more levels,
  /// fewer triangles for an error. Published: 1.
  double share = 0.5;
  std::uint32_t fewest_vertices = 8;  ///< the pass that comes to so many is the last
  /// Refuses collapses that make a triangle with 4 sqrt(3) area / (sum of squared sides) below
  /// this; 0 to 1.
  double smallest_quality = 0;
  /// Called after each pass.
  std::function<void(const PassStatistics&)> passed;
};

/// Builds a merge tree by edge collapses: in each pass as many as have regions that do not meet.
///
/// Guarantees, of the mesh after any set of merges that the tree allows:
/// - it is a manifold with the topology and the borders' number of \p finest;
/// - a height field covers the same plan and no triangle is turned over in plan (exact);
/// - on other meshes every triangle that is not of \p finest faces the same side as the normals of
///   \p finest at its three corners;
/// - no vertex of \p finest is farther from it than the largest error of the merges made.
///
/// Vertices keep their places (rounded to the lattice). In a height field, border vertices go only
/// where the border is straight in plan.
/// \pre \p finest has been through check_surface().
/// \throws ConfigError if an option is out of range; TopologyError if the mesh is not manifold.
/// \par Source
/// Xia and Varshney 1996, section 4.
MergeTree build_merge_tree(const SurfaceMesh& finest, const MergeTreeOptions& options = {});

/// The tree of a hierarchy of triangle collapses: a parent has three children.
///
/// The first two guarantees hold; folds are those that the collapses have, each for itself.
/// \throws InputError if the sequence is damaged.
/// \par Source
/// Xia and Varshney 1996, section 7: other local simplifications as merge trees.
MergeTree merge_tree_of(const LevelSequence& sequence);

}  // namespace terrane::hierarchy

#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/levels/point_lattice.h"
#include "hierarchy/levels/surface_mesh.h"
#include "hierarchy/merge/view_ranges.h"
#include "hierarchy/mesh/halfedge_mesh.h"

namespace terrane::hierarchy {

/// What the errors of a tree are.
enum class ErrorMeasure : std::uint8_t {
  kDistance,  ///< distance of each vertex of the full mesh from the surface shown
  kVertical,  ///< the same along z, of each vertex under a triangle in plan: height fields
};

/// Which triangles an edge collapse (c into p) needs to find as they were when it was built.
enum class Region : std::uint8_t {
  kRemovedEnd,  ///< those at c, which change
  kBothEnds,    ///< those at c and at p, as published
};

/// One collapse: the triangles `fine` and the vertices `children` show before it, `coarse` after.
///
/// An edge: c, the only child, goes into the parent p, which stays. fine is the star of c, coarse
/// the fan of p over the same polygon. A triangle: the three children go, and the parent is there
/// instead. fine is everything at the children, coarse everything at the parent.
struct Merge {
  std::uint32_t parent = 0;
  std::uint32_t first_child = 0;
  std::uint32_t child_count = 1;  ///< 1: edge collapse, 3: triangle collapse
  std::uint32_t level = 1;        ///< pass in which it was built; 1 is the first, at the full mesh
  std::uint32_t fine_begin = 0, fine_end = 0;      ///< ids of triangles
  std::uint32_t coarse_begin = 0, coarse_end = 0;  ///< into MergeTree::coarse_triangles
};

/// What is known of the surface under a merge, and of all that has to merge before it (`all_`).
///
/// Numbers are rounded up to 16 bits: what a file holds is what was measured.
struct MergeBounds {
  float error = 0, all_error = 0;  ///< of the triangles that the merge makes, see ErrorMeasure
  float switched = 0, all_switched = 0;  ///< switch distance: see measure_bounds()
  float radius = 0, all_radius = 0;      ///< of spheres about the first child (edge) or the parent
  float angle = 0, all_angle = 0;        ///< of cones about that vertex's normal, radians, 0 to pi
  float colour = 0, all_colour = 0;      ///< range of the colours, 0 to 1; all_: the largest such

  bool operator==(const MergeBounds&) const = default;
};

/// A mesh at all resolutions at once: its vertices as a forest of merges.
///
/// Merges are numbered from coarse to fine: those with smaller numbers were built later. A merge
/// may be made as soon as all of finer() are, and undone as soon as all of coarser() are undone:
/// exactly then all triangles that it replaces are there. So whatever order they are made in, the
/// triangles shown are always those of a mesh that an ordinary sequence of collapses passes
/// through, and what was checked of each collapse when the tree was built holds.
/// \par Source
/// Xia and Varshney 1996, section 4; what differs is in docs/papers.md.
struct MergeTree {
  PointLattice lattice;
  ErrorMeasure measure = ErrorMeasure::kDistance;
  Region region = Region::kRemovedEnd;

  std::vector<Eigen::Vector3i> points;   ///< lattice steps; those of the coarsest mesh come first
  std::vector<Eigen::Vector3f> normals;  ///< of the full mesh, unit; one for each point
  std::vector<Colour> colours;           ///< one for each point, or none
  std::vector<Corners> triangles;        ///< all that ever show, those of the coarsest mesh first
  std::uint32_t coarsest_points = 0, coarsest_triangles = 0;

  std::vector<Merge> merges;
  std::vector<MergeBounds> bounds;      ///< one for each merge
  std::vector<ViewRanges> view_ranges;  ///< the same, as views read them: view_ranges_of()
  std::vector<std::uint32_t> coarse_triangles;

  std::vector<std::uint32_t> coarser_begin, coarser_merges;  ///< compressed rows: coarser()
  std::vector<std::uint32_t> finer_begin, finer_merges;

  std::uint32_t merge_count() const { return static_cast<std::uint32_t>(merges.size()); }
  /// Passes that built it.
  std::uint32_t level_count() const;
  /// Triangles and vertices of the full mesh.
  std::uint32_t full_triangle_count() const;
  std::uint32_t full_point_count() const;

  /// Ids of the triangles that show after merge i.
  std::span<const std::uint32_t> coarse(std::uint32_t i) const {
    return std::span(coarse_triangles)
        .subspan(merges[i].coarse_begin, merges[i].coarse_end - merges[i].coarse_begin);
  }
  /// Merges that have to be undone before merge i is; all below i.
  std::span<const std::uint32_t> coarser(std::uint32_t i) const {
    return row(coarser_begin, coarser_merges, i);
  }
  /// Merges that have to be made before merge i is; all above i.
  std::span<const std::uint32_t> finer(std::uint32_t i) const {
    return row(finer_begin, finer_merges, i);
  }
  /// The vertex that the sphere and the cone of merge i are about.
  std::uint32_t centre(std::uint32_t i) const {
    return merges[i].child_count == 1 ? merges[i].first_child : merges[i].parent;
  }
  /// Relative to the lattice's origin; exact.
  Eigen::Vector3f place(std::uint32_t vertex) const {
    return lattice.relative(points[vertex]).cast<float>();
  }

 private:
  static std::span<const std::uint32_t> row(const std::vector<std::uint32_t>& begin,
                                            const std::vector<std::uint32_t>& values,
                                            std::uint32_t i) {
    return std::span(values).subspan(begin[i], begin[i + 1] - begin[i]);
  }
};

/// The box about all places of a tree, relative to its lattice's origin.
struct TreeExtent {
  Eigen::Vector3d middle;
  double reach;  ///< half its diagonal
};
TreeExtent extent_of(const MergeTree& tree);

/// Is each triangle of the full mesh? By id.
std::vector<bool> full_triangles(const MergeTree& tree);

}  // namespace terrane::hierarchy

#pragma once

#include <optional>

#include "hierarchy/levels/border_rule.h"
#include "hierarchy/levels/level_mesh.h"
#include "hierarchy/levels/local_surface.h"
#include "hierarchy/mesh/stencil.h"

namespace terrane::hierarchy {

/// What a triangle's collapse would be.
struct CollapsePlan {
  Eigen::Vector3d point;   ///< the collapse point, on the lattice
  std::uint32_t kept = 0;  ///< core vertex of the stencil that lives on
};

/// Judges single triangles of the current mesh; keeps the scratch space. One for each thread.
class CollapseJudge {
 public:
  CollapseJudge(const LevelMesh& level, Rules rules);

  /// The approximating surface of a triangle: over its ancestral points where there are enough,
  /// else over those of its stencil, widened ring by ring until the system is regular.
  /// A mesh too small for that counts as flat.
  LocalSurface surface(TriangleId t, const TriangleFrame& frame);

  /// Is the triangle collapsible, and where does it go?
  /// \return nothing if not; rejection() says why. stencil() is that of \p t afterwards.
  std::optional<CollapsePlan> plan(TriangleId t, const TriangleFrame& frame,
                                   const LocalSurface& surface) {
    return find_stencil(t) ? place(frame, surface) : std::nullopt;
  }
  /// The first half of plan(): is the stencil complete, and would it leave no cycle?
  bool find_stencil(TriangleId t);
  /// The second half. \pre find_stencil() has just found that of the triangle.
  std::optional<CollapsePlan> place(const TriangleFrame& frame, const LocalSurface& surface);

  /// E(T): largest distance between the surface and the edges of the star about the collapse point.
  /// \pre plan() has just found \p plan.
  double predictive_error(const TriangleFrame& frame, const LocalSurface& surface,
                          const CollapsePlan& plan) const;

  const Stencil& stencil() const { return stencil_; }
  Rejection rejection() const { return rejection_; }
  /// The frame of a triangle; nothing if it has no area.
  std::optional<TriangleFrame> frame(TriangleId t) const;

 private:
  void add_ancestors(VertexId v, const TriangleFrame& frame);
  bool widen();
  Eigen::Vector3d collapse_point(const BorderRule& rule, const TriangleFrame& frame,
                                 const LocalSurface& surface) const;
  bool sees_polygon(const Eigen::Vector3d& point, const TriangleFrame& frame) const;
  bool sees_polygon_in_plan(const Eigen::Vector3d& point) const;

  const LevelMesh& level_;
  Rules rules_;
  StencilWalker walker_;
  Stencil stencil_;
  SurfaceFitter fitter_;
  std::vector<VertexId> ring_;
  std::size_t ring_begin_ = 0;  // of the outermost ring, in ring_
  Rejection rejection_ = Rejection::kOverlap;
};

}  // namespace terrane::hierarchy

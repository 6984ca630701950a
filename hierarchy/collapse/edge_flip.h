#pragma once

#include <span>
#include <vector>

#include "hierarchy/collapse/covered_samples.h"
#include "hierarchy/collapse/terrain_mesh.h"
#include "hierarchy/collapse/triangle_shape.h"
#include "hierarchy/mesh/halfedge_mesh.h"

namespace terrane::hierarchy {

/// Judges whether the other diagonal of the two triangles at an edge is nearer to the samples.
///
///         c                c
///        ╱ ╲              ╱│╲        h runs from a to b; afterwards triangle(h) is (a, d, c), the
///       a───b     ──▶    a │ b       one across (b, c, d)
///        ╲ ╱              ╲│╱
///         d                d
///
/// Keeps its scratch space from call to call.
class EdgeFlip {
 public:
  /// True if the flipped pair is well shaped (triangle_shape.h), within \p tolerance_m of every
  /// sample under it, and its sum of squared errors is smaller.
  ///
  /// An edge with both ends on a line, a seam or the outline stays, and none is made.
  bool is_better(HalfedgeId h, const HalfedgeMesh& mesh, std::span<const TerrainVertex> vertices,
                 const CoveredSamples& samples, double tolerance_m, const ShapeLimits& limits,
                 const Placer& placer);

  /// The samples under the pair that was last better.
  std::span<const CoveredSample> samples() const { return samples_; }
  /// So many of them, the first ones, are keen.
  std::size_t keen_count() const { return keen_count_; }
  /// For each of them: 0 if it comes to lie in triangle(h), 1 across.
  std::span<const std::uint32_t> sector() const { return sector_; }

 private:
  std::vector<CoveredSample> samples_;
  std::size_t keen_count_ = 0;
  std::vector<std::uint32_t> sector_;
};

}  // namespace terrane::hierarchy

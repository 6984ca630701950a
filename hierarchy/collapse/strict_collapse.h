#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "hierarchy/collapse/finer_level.h"
#include "hierarchy/collapse/line_chains.h"
#include "hierarchy/collapse/sample_field.h"
#include "hierarchy/collapse/terrain_mesh.h"
#include "hierarchy/collapse/triangle_shape.h"
#include "hierarchy/mesh/stencil.h"

namespace terrane::hierarchy {

/// How much time goes into a mesh of level 0; see StrictOptions::effort.
inline constexpr int kDefaultEffort = 1, kTopEffort = 3;

struct StrictOptions {
  /// Largest vertical distance to any sample, in metres.
  double tolerance_m = 1;
  /// Of new triangles.
  ShapeLimits shape;
  /// 0 to 3. Above 0, vertices are moved to where the squared error is least, without a finer level
  /// edges are flipped, too, and collapses tried again, in more and more rounds (polish_rounds.h);
  /// at 1 without a finer level near locked vertices alone. 0: without a finer level, triangles
  /// alone collapse; with one, few places are tried for a new vertex.
  int effort = kDefaultEffort;
  /// Whether there is polish at all: it moves vertices by the field's samples, and where those are
  /// not nearly as the world has them, that may never end within a tolerance there.
  bool has_polish = true;
  /// How far the mesh's feature lines may move in plan.
  LineTolerance lines;
};

/// What became of a mesh.
struct StrictResult {
  TerrainMesh mesh;
  /// For each vertex of the input: the vertex of mesh that it was collapsed into, or that its
  /// finer.target was.
  std::vector<std::uint32_t> target;
  std::int64_t triangle_collapses = 0;
  std::int64_t edge_collapses = 0;
  std::int64_t flips = 0;
  std::int64_t moves = 0;
  std::array<std::int64_t, kCollapsibilityCount> refusals{};  ///< by Collapsibility
};

/// Collapses triangles, then edges, and polishes if asked to, as long as the mesh stays within the
/// tolerance of every sample.
///
/// Sweeps run in memory order over stencils that do not meet. A collapse is accepted when the star
/// that replaces the stencil, at its written (rounded) places, is within the tolerance of every
/// sample that it covers, is nowhere folded in plan, keeps lines in place (boundary_rule.h) and, if
/// there is a finer level, lets it blend soundly (morph_guard.h). A vertex in water stays at the
/// water's height, a triangle in water stays in water.
///
/// Guarantees: samples that \p input covers within the tolerance stay so; outline and locked
/// vertices that remain have not moved; the result depends on nothing but the arguments.
///
/// \param finer  the level that input was made from; without places at level 0.
/// \throws TopologyError if \p input is not manifold.
/// \par Source
/// Gieng et al. 1998 for the collapse; acceptance by the exact error instead of its estimate.
StrictResult collapse_strictly(const TerrainMesh& input, const SampleField& field,
                               const Placer& placer, const FinerLevel& finer,
                               const StrictOptions& options);

}  // namespace terrane::hierarchy

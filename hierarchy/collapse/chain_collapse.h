#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "hierarchy/collapse/finer_level.h"
#include "hierarchy/collapse/sample_field.h"
#include "hierarchy/collapse/terrain_mesh.h"

namespace terrane::hierarchy {

struct ChainOptions {
  /// Largest vertical distance of the chain's triangles to any sample, in metres.
  double tolerance_m = 1;
  /// Largest vertical distance during the blend from the finer level, in metres.
  double blend_tolerance_m = 1;
  /// Smallest altitude in plan of a new triangle, in cells: rounding must not turn it over.
  double smallest_altitude_cells = 0;
  /// How far in plan a new edge may lie beside the line of samples that it stands for, in metres,
  /// where the mesh goes on on both sides. Half a cell at most: then a tile's own samples and those
  /// on its border are all that it can cover.
  double largest_bend_m = 0;
  /// Where a vertex at a sample of the chain's line is written at a wished height. Empty: all
  /// vertices keep their places.
  std::function<Place(const SampleId& at, double height_m)> place_at;
};

/// What became of a chain.
struct ChainResult {
  std::vector<std::uint32_t> target;  ///< for each vertex of the strip: itself, or where it went
  std::vector<Place> places;          ///< of each vertex of the strip
  std::vector<BorderPlace> borders;   ///< of each: where it is now
  std::vector<double> raised_m;       ///< for each: the height last wished for it; NaN: as it was
  std::int64_t collapses = 0;
  std::int64_t refused_by_blend = 0;  ///< what the error allowed and the blend did not
};

/// Thins out the line of vertices that two meshes share, so that both remain within the tolerance.
///
/// A vertex of the chain collapses onto its neighbour in the chain, which keeps its place in plan
/// and, unless it is locked, is put at the height that is best for the samples around both. The
/// collapse stands if all triangles of both meshes around the vertices allow it: none folds
/// or becomes too thin in plan, every sample under the new ones is within the tolerance, and the
/// finer level, if there is one, blends soundly (morph_guard.h). The smallest error goes first;
/// among equals, the collapse that leaves the fattest triangles.
///
/// Guarantees: only triangles around removed vertices change, so chains whose removable vertices
/// share no triangle may be done in any order; the result depends on nothing but the arguments.
///
/// \param strip  the triangles around the chain's vertices, of both meshes, joined; more do no
///               harm.
/// \param chain  its vertices in order along their line of samples. Those of kind kLocked stay, and
///               so does one whose triangles are not one fan from one neighbour to the other.
/// \param finer  the finer level of the strip (with its own triangles); places empty at level 0.
ChainResult collapse_chain(const TerrainMesh& strip, std::span<const std::uint32_t> chain,
                           const FinerLevel& finer, const SampleField& field, const Placer& placer,
                           const ChainOptions& options);

}  // namespace terrane::hierarchy

#pragma once

#include <optional>
#include <span>

#include "hierarchy/collapse/line_chains.h"
#include "hierarchy/collapse/terrain_mesh.h"
#include "hierarchy/mesh/stencil.h"

namespace terrane::hierarchy {

/// How a core lies to the lines of a mesh (outline, seams and features).
///
/// \par Source
/// Gieng et al. 1998, section 3.3: boundary types 1 to 4.
enum class BoundaryType : std::uint8_t {
  kInterior,  ///< no corner on a line: the new vertex may be anywhere
  kEdge,      ///< type 1: an edge on the line; it collapses along the line
  kVertex,    ///< type 2: one corner on the line; the core collapses onto it
  kFixed,     ///< types 3 and 4: may not collapse, but may be a neighbour
};

/// Where a core may go.
struct BoundaryVerdict {
  BoundaryType type = BoundaryType::kFixed;
  std::optional<VertexId> onto;  ///< the corner to collapse onto, for kEdge and kVertex
};

/// Decides from the kinds of the core's corners. A corner on the outline gives way only along a
/// straight run of samples, so no sample is ever uncovered and none is invented; a locked one
/// never; one on a feature line only along that line (line_chains.h).
///
/// \param lines  null if the mesh has no feature lines.
/// \pre \p stencil is complete.
BoundaryVerdict classify(const Stencil& stencil, const HalfedgeMesh& mesh,
                         std::span<const TerrainVertex> vertices, const Placer& placer,
                         const LineChains* lines = nullptr);

}  // namespace terrane::hierarchy

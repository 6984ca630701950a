#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/collapse/terrain_mesh.h"
#include "hierarchy/mesh/halfedge_mesh.h"

namespace terrane::hierarchy {

/// Marks the vertices that are at most so many edges away from a locked one.
///
/// \return for each vertex of the mesh 1 or 0.
std::vector<std::uint8_t> near_locked(const HalfedgeMesh& mesh,
                                      std::span<const TerrainVertex> vertices, int edges);

}  // namespace terrane::hierarchy

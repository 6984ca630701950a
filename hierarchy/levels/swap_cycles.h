#pragma once

#include <cstdint>

#include "hierarchy/levels/surface_mesh.h"

namespace terrane::hierarchy {

/// What swap_cycles() did.
struct CycleSwaps {
  std::uint32_t found = 0;    ///< vertices of valence 3 inside the mesh
  std::uint32_t removed = 0;  ///< of them, given a fourth edge
};

/// Removes the cycles of a mesh by edge swaps: three triangles about a vertex of valence 3 are
/// pairwise neighbours, and no stencil that holds them is complete. The edge between the cycle and
/// a triangle outside is swapped for the one from the vertex to that triangle's far corner; of the
/// three possible ones the one that bends the surface least.
///
/// A swap is left out where it would make another vertex lose its fourth edge, join two vertices
/// that are joined already, or turn a triangle over.
/// \par Source
/// Gieng et al. 1998, section 3.1 (figure 3), which describes and does not implement it. Collapses
/// make no new cycles, so it is enough to do it once, in M_0.
CycleSwaps swap_cycles(SurfaceMesh& mesh);

}  // namespace terrane::hierarchy

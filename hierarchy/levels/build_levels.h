#pragma once

#include "hierarchy/levels/level_options.h"
#include "hierarchy/levels/level_sequence.h"
#include "hierarchy/levels/surface_mesh.h"

namespace terrane::hierarchy {

/// Builds M_0, ..., M_n; M_i becomes M_(i+1) by collapsing triangles whose stencils do not meet.
///
/// M_0 is \p finest with every coordinate rounded to the lattice (PointLattice::around: a
/// four-millionth of the mesh's extent or less).
///
/// Guarantees: every level is a manifold with the Euler characteristic of \p finest; with the
/// tightened rules a height field covers the same plan at every level and folds nowhere. The result
/// depends on nothing but the arguments, least of all on the number of threads. Ends early where no
/// triangle is collapsible.
///
/// \pre \p finest has been through check_surface().
/// \throws ConfigError if an option is out of range; TopologyError if the mesh is not manifold.
/// \par Source
/// Gieng et al. 1998; what differs is in docs/papers.md.
LevelSequence build_levels(const SurfaceMesh& finest, const LevelOptions& options = {});

/// Does every triangle of a mesh face the same way in plan (x, y)? Then it is the graph of a
/// function wherever its border does not wind over itself.
bool is_height_field(const SurfaceMesh& mesh);

}  // namespace terrane::hierarchy

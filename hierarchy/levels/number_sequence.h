#pragma once

#include <vector>

#include "hierarchy/levels/level_mesh.h"
#include "hierarchy/levels/level_sequence.h"

namespace terrane::hierarchy {

/// Makes the sequence of a mesh and the collapses that led to it.
///
/// \param level    M_n
/// \param records  records[i] leads from M_i to M_(i+1); vertices by their LevelMesh::names.
/// \param finest_vertex_count  names are smaller.
/// \return the same with the numbers of a LevelSequence.
LevelSequence number_sequence(const LevelMesh& level, std::vector<std::vector<Collapse>> records,
                              std::uint32_t finest_vertex_count);

/// Takes the last level back: M_(n-1) becomes the coarsest mesh.
/// \pre there is a level.
void drop_coarsest(LevelSequence& sequence);

}  // namespace terrane::hierarchy

#pragma once

#include <cstdint>
#include <vector>

#include "hierarchy/volume/tetra_mesh.h"

namespace terrane::hierarchy::volume {

/// Vertices of leaves, numbered without gaps in the order that the leaves meet them.
struct LeafNumbering {
  std::vector<NodeId> nodes;         ///< by number
  std::vector<std::int64_t> number;  ///< by node; -1: of no leaf
};

/// Numbers the vertices of some leaves. In the tree's order (TetraMesh::leaves_in_tree_order) the
/// result does not depend on the history of splits and merges.
LeafNumbering number_nodes(const TetraMesh& mesh, const std::vector<CellId>& leaves);

}  // namespace terrane::hierarchy::volume

#include "hierarchy/volume/leaf_numbering.h"

namespace terrane::hierarchy::volume {

LeafNumbering number_nodes(const TetraMesh& mesh, const std::vector<CellId>& leaves) {
  LeafNumbering numbering{{}, std::vector<std::int64_t>(mesh.node_capacity(), -1)};
  for (const CellId leaf : leaves) {
    for (const NodeId node : mesh.corners(leaf)) {
      auto& number = numbering.number[index(node)];
      if (number >= 0) continue;
      number = static_cast<std::int64_t>(numbering.nodes.size());
      numbering.nodes.push_back(node);
    }
  }
  return numbering;
}

}  // namespace terrane::hierarchy::volume

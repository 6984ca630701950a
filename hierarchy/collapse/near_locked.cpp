#include "hierarchy/collapse/near_locked.h"

namespace terrane::hierarchy {

std::vector<std::uint8_t> near_locked(const HalfedgeMesh& mesh,
                                      std::span<const TerrainVertex> vertices, int edges) {
  std::vector<std::uint8_t> is_near(vertices.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    is_near[v] = vertices[v].kind == VertexKind::kLocked ? 1 : 0;
  }
  for (int done = 0; done < edges; ++done) {
    const std::vector<std::uint8_t> was_near = is_near;
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
      if (!mesh.is_live(TriangleId{t}) || mesh.is_ghost(TriangleId{t})) continue;
      const HalfedgeId h = HalfedgeMesh::halfedge(TriangleId{t}, 0);
      const std::size_t a = index(mesh.start(h)), b = index(mesh.end(h)), c = index(mesh.apex(h));
      if ((was_near[a] | was_near[b] | was_near[c]) != 0) is_near[a] = is_near[b] = is_near[c] = 1;
    }
  }
  return is_near;
}

}  // namespace terrane::hierarchy

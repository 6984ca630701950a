#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/mesh/halfedge_mesh.h"

namespace terrane::hierarchy {

/// Which vertices of a mesh have an edge with a triangle on one side only; without building a
/// HalfedgeMesh, whose is_boundary() says the same.
///
/// A vertex with one fan of triangles is judged exactly. Where several open fans meet, all of them
/// may be taken for closed with a chance of 2^-64.
/// \pre the triangles make a HalfedgeMesh.
std::vector<bool> boundary_vertices(std::size_t vertex_count, std::span<const Corners> triangles);

}  // namespace terrane::hierarchy

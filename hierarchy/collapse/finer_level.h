#pragma once

#include <cstdint>
#include <vector>

#include "hierarchy/collapse/terrain_mesh.h"

namespace terrane::hierarchy {

/// The level that a mesh to be collapsed was made from, vertex by vertex, and how far it has come.
struct FinerLevel {
  std::vector<Place> places;          ///< one for each vertex of the mesh; empty at level 0
  std::vector<Corners> triangles;     ///< the finer level's, over the same vertices
  std::vector<std::uint32_t> target;  ///< what each has been collapsed into so far; empty: itself

  std::uint32_t target_of(std::uint32_t v) const { return target.empty() ? v : target[v]; }
};

}  // namespace terrane::hierarchy

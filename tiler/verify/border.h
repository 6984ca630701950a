#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <utility>
#include <vector>

#include "tiler/verify/placed_mesh.h"
#include "tiler/verify/valid_domain.h"

namespace terrane::verify {

/// Edges that only one triangle of a tile has.
struct Boundary {
  std::vector<std::array<std::uint32_t, 2>> edges;  ///< vertices of the tile
  std::int64_t torn = 0;  ///< edges whose two sides part at t > 0, or that are there twice
};

Boundary find_boundary(const TileMesh& mesh);

/// A vertex on a seam. Equal if place and displacement are the same integers.
struct SeamVertex {
  Lattice place = {};
  Lattice morph = {};
  double along = 0;  ///< row (or column) on its line; for messages, not compared

  bool operator==(const SeamVertex& other) const {
    return place == other.place && morph == other.morph;
  }
  std::strong_ordering operator<=>(const SeamVertex& other) const {
    if (const auto order = place <=> other.place; order != 0) return order;
    return morph <=> other.morph;
  }
};

/// A set: sorted, each once.
using SeamVertices = std::vector<SeamVertex>;

/// What a tile shows on its four sides, in the order of Side: the ends of boundary edges that run
/// along the shared runs of that side.
///
/// \param step_m  the step in plan of the tile's level.
std::array<SeamVertices, 4> side_vertices(const PlacedMesh& mesh, const Boundary& boundary,
                                          const Window& tile_window, const ValidDomain& domain,
                                          double step_m);

/// The same vertices at t = 1, as places without displacement, on the lattice of the same level.
SeamVertices at_next_level(const SeamVertices& vertices);

/// Elements of one set but not of the other.
SeamVertices difference(const SeamVertices& a, const SeamVertices& b);

SeamVertices unite(const SeamVertices& a, const SeamVertices& b);

}  // namespace terrane::verify

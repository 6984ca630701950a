#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tiler/verify/output.h"

namespace terrane::verify {

/// A point of the world lattice of one level: (i, j, k).
using Lattice = std::array<std::int64_t, 3>;

Lattice operator+(const Lattice& a, const Lattice& b);
Lattice operator-(const Lattice& a, const Lattice& b);

/// A tile as its glb holds it, back on the lattice of its level.
struct TileMesh {
  TileKey key;
  std::int64_t bytes = 0;
  std::vector<Lattice> position;  ///< at t = 0
  std::vector<Lattice> morph;     ///< displacement to t = 1
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<bool> in_water;  ///< of each triangle: has it the material "water"?
  std::vector<Lattice> hem;    ///< lower ends of its skirts at t = 0 and at t = 1, if it has any
  std::vector<std::string> misstated;  ///< what the glb says of itself and is not so

  Lattice target(std::size_t vertex) const { return position[vertex] + morph[vertex]; }
};

/// Reads and decodes the glb of a tile that tileset.json lists.
/// \throws InputError if it is missing or damaged.
TileMesh read_tile_mesh(const Output& output, const TileKey& key);

}  // namespace terrane::verify

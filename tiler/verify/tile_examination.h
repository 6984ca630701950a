#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "tiler/verify/border.h"
#include "tiler/verify/placed_mesh.h"
#include "tiler/verify/sample_tally.h"
#include "tiler/verify/water_triangles.h"

namespace terrane::verify {

/// Three corners in order, the smallest first, so that equal triangles are equal values.
using LatticeTriangle = std::array<Lattice, 3>;

/// What one tile's files say by themselves, kept until its neighbours and parent are compared.
struct TileFindings {
  TileKey key;
  std::unique_ptr<PlacedMesh> placed;  ///< null if tileset.json does not list the tile
  std::array<std::int64_t, kTimeCount> folded = {};  ///< see time_at()
  std::int64_t torn_edges = 0;
  std::int64_t vertices_with_morph = 0;
  std::int64_t vertices_outside_box = 0;
  std::int64_t water_triangles = 0, uneven_water_triangles = 0;
  double measured_error_m = 0;                 ///< filled in as blocks are judged
  std::array<SeamVertices, 4> sides;           ///< by Side
  std::vector<LatticeTriangle> at_rest;        ///< sorted
  std::vector<LatticeTriangle> at_next_level;  ///< at t = 1, those without area left out; sorted
  std::vector<std::string> misstated;
  std::vector<std::string> problems;
};

/// Reads a tile and checks what can be checked without its neighbours. Thread-safe.
/// \throws InputError if its glb is missing or damaged.
TileFindings examine_tile(const Output& output, const World& world, const ValidDomain& domain,
                          const WaterJudge& water, const TileKey& key);

}  // namespace terrane::verify

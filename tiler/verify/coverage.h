#pragma once

#include <cstdint>
#include <vector>

#include "tiler/verify/placed_mesh.h"
#include "tiler/verify/sample_block.h"

namespace terrane::verify {

/// How a mesh covers a sample, worst first.
enum class Cover : std::uint8_t {
  kNone,  ///< no triangle above or below
  kNear,  ///< the mesh ends within one lattice step of the sample
  kHit    ///< the sample's vertical meets a triangle
};

/// One sample against one mesh.
struct Verdict {
  Cover cover = Cover::kNone;
  double error_m = 0;  ///< |mesh - DEM| along the vertical; the worst, if several triangles are hit
  bool under_land = false, under_water = false;  ///< what triangles were hit: both on a shore
};

/// What two meshes (neighbours, of which either may cover the sample) say together.
Verdict merge(const Verdict& a, const Verdict& b);

/// Judges every sample of a block against tiles at morph t. Samples that are no terrain get kNone.
///
/// \param meshes  the tile above the block; while it morphs, also its siblings.
/// \param near_m  one lattice step in plan: how far from the outline a sample may lie.
std::vector<Verdict> judge(const SampleBlock& block, const std::vector<const PlacedMesh*>& meshes,
                           double t, double near_m);

}  // namespace terrane::verify

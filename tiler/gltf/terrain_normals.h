#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hierarchy/collapse/terrain_mesh.h"
#include "tiler/tile/tile_frame.h"
#include "tiler/tile/tile_samples.h"

namespace terrane::tiler {

/// Samples on each side that the slope at a vertex is taken over: as wide as the level is coarse.
/// \param octave  of the level, see Pyramid.
std::int64_t normal_reach(int octave);

/// Normals of the terrain itself (not of the mesh), so that both sides of a seam agree.
///
/// \param samples  read with a margin of normal_reach(octave).
/// \return one unit vector in the world for each place.
std::vector<Eigen::Vector3f> terrain_normals(std::span<const hierarchy::Place> places,
                                             const TileFrame& frame, int octave,
                                             const TileSamples& samples);

}  // namespace terrane::tiler

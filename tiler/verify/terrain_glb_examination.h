#pragma once

#include <vector>

#include "tiler/verify/terrain_examination.h"
#include "tiler/verify/terrain_file.h"
#include "tiler/verify/terrain_layer.h"

namespace terrane::verify {

/// Judges what is said in other ways in a glb than in quantized-mesh: triangles, cover, border
/// lists, heights.
///
/// Places are floats, and at a pole there are no longitudes: so the cover is judged by how
/// triangles are joined. Triangles that face up in longitude and latitude, whose open edges run
/// once along each border list, cover the tile once. Those with a corner at a pole are not asked
/// which way they face.
///
/// \pre examine_indices() found nothing.
std::vector<FaultFound> examine_terrain_glb(const TerrainFile& tile, const TerrainKey& key,
                                            const TerrainLayer& layer);

}  // namespace terrane::verify

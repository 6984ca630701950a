#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "tiler/verify/terrain_file.h"
#include "tiler/verify/terrain_layer.h"
#include "tiler/verify/terrain_report.h"

namespace terrane::verify {

/// Earth-centred places of a tile's vertices, in metres.
std::vector<Eigen::Vector3d> ecef_of(const TerrainFile& tile, const TerrainKey& key);

/// Reads a tile in the format of its set.
/// \throws InputError that names the file if it is missing or damaged.
TerrainFile read_tile(const TerrainLayer& layer, const TerrainKey& key);

/// Faults of one kind in one tile.
struct FaultFound {
  TerrainFault fault = TerrainFault::kMissing;
  std::int64_t count = 1;
  std::string what;  ///< to stand behind the tile's name
};

/// Judges what can be said of a tile alone: triangles, lists, heights, volumes, extensions.
std::vector<FaultFound> examine_terrain(const TerrainFile& tile, const TerrainKey& key,
                                        const TerrainLayer& layer);

/// A vertex on a border, to be compared with a neighbour's. Of a glb: the bits of its Earth-centred
/// place. Of quantized-mesh: where along the border, and the height in whole micrometres (clients
/// interpolate between minimum and maximum, which is off by rounding where the height is 0).
using BorderVertex = std::array<std::int64_t, 3>;

/// Those of one side, in order. Of quantized-mesh by their places, not by the tile's lists.
std::vector<BorderVertex> border_of(const TerrainFile& tile, TerrainFile::Side side);

}  // namespace terrane::verify

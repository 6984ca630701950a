#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "core/geodetic_grid.h"
#include "core/progress.h"
#include "tiler/geodetic/terrain_tile.h"
#include "tiler/tile/tile_mesh.h"

namespace terrane::tiler {

/// Some tiles of one zoom, and the levels that are built from them.
struct BandOptions {
  GeodeticTiles tiles;              ///< of the finest zoom, whole tiles of the coarsest level
  std::vector<double> tolerance_m;  ///< of each level, the finest first
  GeodeticTiles wanted;             ///< of the finest zoom: tiles that hold none are not written
  bool holds_dem_samples = false;   ///< and not only the posts; for the finest zoom alone
  std::filesystem::path work;       ///< folder for what is under way
  int jobs = 1;
};

/// Encodes and writes a finished tile.
/// \return the number of bytes.
using WriteTerrain = std::function<std::int64_t(const TerrainTile&)>;

/// Builds the tiles of a band, level by level, each within its tolerance of every post that it
/// covers (and every sample of the DEM, if asked to), and hands them to \p write as soon as they
/// are finished, from several threads.
///
/// Goes on from what an earlier run left in the work folder.
/// \return what was written, in no particular order; TileId as the band counts.
/// \throws ConfigError if a tile reaches so far round the Earth that the tolerance cannot be held.
std::vector<TileRecord> build_band(const GeodeticHeights& heights, const BandOptions& options,
                                   const WriteTerrain& write, Progress& progress);

}  // namespace terrane::tiler

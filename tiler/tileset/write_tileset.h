#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/height_source.h"
#include "core/height_statistics.h"
#include "tiler/pyramid.h"
#include "tiler/tile/lattice.h"
#include "tiler/tile/plan_map.h"
#include "tiler/tile/tile_mesh.h"
#include "tiler/tile/world_frame.h"
#include "tiler/tile_format.h"

namespace terrane::tiler {

/// Everything about a finished data set that its JSON files tell.
struct DataSet {
  GridShape shape;
  HeightStatistics heights;
  std::string crs_wkt;
  std::optional<PlanMap> plan;  ///< to the plan of the CRS; none if it is WGS84 or there is no CRS
  std::int64_t tile_cells = 64;
  int levels_per_octave = 1;
  std::vector<double> tolerance_m;  ///< of each level
  TileFormat format;
  std::string key;  ///< what the data set was built from; see build_key()
};

/// A file of an output, by its path there.
struct OutputFile {
  std::string path;
  std::string content;
};

/// The 3D Tiles 1.1 tilesets: one tree with the root's transform to ECEF where the frame has one;
/// `tileset.json` comes last. Split, or implicit with its subtrees, as the format says.
///
/// \param records  of every written tile, in any order.
std::vector<OutputFile> tileset_files(const DataSet& data_set, const Pyramid& pyramid,
                                      const WorldFrame& world,
                                      const std::vector<TileRecord>& records);

/// terrane.json: levels with their sums, lattice and frame.
/// \param tilesets  what tileset_files() gave.
std::string terrane_json(const DataSet& data_set, const Lattice& lattice, const WorldFrame& world,
                         const std::vector<TileRecord>& records,
                         const std::vector<OutputFile>& tilesets);

}  // namespace terrane::tiler

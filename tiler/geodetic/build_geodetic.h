#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/geodetic_grid.h"
#include "core/height_statistics.h"
#include "core/progress.h"
#include "tiler/build.h"

namespace terrane::tiler {

/// How the posts came about, for terrane.json.
struct ResamplingFacts {
  std::string method;
  double max_error_m = 0;  ///< of the DEM's samples to the surface between the posts
  double rms_error_m = 0;
};

/// What terrain tiles are written as.
enum class TerrainFormat {
  kQuantizedMesh,  ///< with a layer.json
  k3dTiles         ///< glb tiles and subtrees, for Cesium3DTilesTerrainProvider
};

struct GeodeticOptions {
  TerrainFormat format = TerrainFormat::kQuantizedMesh;
  /// Largest vertical distance of the finest zoom to any post of its grid, in metres; doubles with
  /// each coarser zoom.
  double tolerance_m = 1;
  /// Whether the tolerance holds at each sample of the DEM as well.
  /// \pre the surface of the finest posts is nearer to all of them.
  bool holds_dem_samples = false;
  int jobs = 0;  ///< threads; 0: as many as the machine has cores
  /// What tells this data set from others with the same heights: how they were resampled, filled
  /// and raised to the ellipsoid.
  std::string source;
  ResamplingFacts resampling;
  std::string attribution;
  /// The water mask of a tile, as TerrainTile has it; none without water. For quantized-mesh.
  std::function<std::string(double west_deg, double south_deg, double east_deg, double north_deg)>
      water;
  std::string water_fingerprint;  ///< changes whenever the mask does
};

/// The key that a finished data set of these options has.
std::string geodetic_key(const HeightStatistics& statistics, const GeodeticOptions& options);

/// Is the data set of this key here, with all its files?
bool is_finished(const std::filesystem::path& out, const std::string& key);

/// Builds the tiles of the geodetic quadtree from its roots to the finest zoom and writes them as
/// quantized-mesh with a layer.json, or as 3D Tiles (docs/formats.md).
///
/// Guarantees: neighbours of a zoom hold the same border vertices and decode to equal heights
/// there. From the finest zoom up to that at which four tiles at most hold the whole DEM, each tile
/// is within tolerance_m * 2^level of every post of the *finest* grid (and of every sample of the
/// DEM, if asked to) as CesiumJS draws it (flat triangles between Earth-centred places). The zooms
/// beyond have a grid of their own each.
///
/// \pre \p out was claimed (tiler/output_folder.h).
/// \throws ConfigError, InputError, OutputError.
BuildResult build_geodetic(const GeodeticHeights& heights, const HeightStatistics& statistics,
                           const GeodeticOptions& options, const std::filesystem::path& out,
                           Progress& progress);

}  // namespace terrane::tiler

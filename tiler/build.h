#pragma once

#include <filesystem>
#include <string>

#include "core/georeference.h"
#include "core/grid_features.h"
#include "core/height_source.h"
#include "core/height_statistics.h"
#include "core/progress.h"
#include "core/texture_source.h"
#include "hierarchy/collapse/strict_collapse.h"
#include "tiler/tile_format.h"

namespace terrane::tiler {

struct BuildOptions {
  /// Largest vertical distance between level 0 and any sample, in metres; doubles with each octave.
  double tolerance_m = 1;
  /// Cells along a leaf tile, 4 to 1024.
  int tile_cells = 64;
  /// Levels in each doubling of the tolerance, 1 to 4: that many have the same tiles.
  int levels_per_octave = 1;
  /// Time for fewer triangles, 0 to 3; see hierarchy::StrictOptions::effort.
  int effort = hierarchy::kDefaultEffort;
  /// Lines that stay edges of every level, within its tolerance of their place in plan, and water;
  /// laid for rounded places (ingest/features.h). The DEM has its water at one height already.
  GridFeatures features;
  /// Threads; 0: as many as the machine has cores. Does not change the output.
  int jobs = 0;
  TileFormat format;
  /// Draped over the tiles, if any; must outlive the build.
  const TextureSource* texture = nullptr;
};

/// \throws ConfigError that names the setting, if one is out of range.
void check(const BuildOptions& options);

/// Finds out at once what would else show after hours, at the coarsest level.
/// \throws InputError if the DEM has no place on the Earth, or its projection bends so much over
/// the
///         whole DEM that tiles cannot follow it.
void check_place(GridShape shape, const Georeference& place, const HeightStatistics& statistics,
                 const BuildOptions& options);

struct BuildResult {
  bool was_up_to_date = false;  ///< nothing was left to do
  int levels = 0;
  std::int64_t tiles = 0;
  std::int64_t triangles = 0;  ///< of level 0
  std::int64_t bytes = 0;
  double max_error_m = 0;  ///< of level 0
};

/// Builds the tiles of a DEM into a folder, level by level, as docs/formats.md describes.
///
/// Guarantees: every tile of level l is within tolerance_m * 2^(l / levels_per_octave) of every
/// sample that it covers, as measured in the world; neighbours share their borders as integers; the
/// bytes depend on heights, georeference and options alone, not on jobs, and not on whether earlier
/// runs were killed: what they finished is kept. terrane.json is written last.
///
/// \pre \p out was claimed (tiler/output_folder.h).
/// \throws ConfigError, InputError, OutputError.
/// \par Source
/// docs/architecture.md, "Level building".
BuildResult build(const HeightSource& heights, const Georeference& place,
                  const HeightStatistics& statistics, const BuildOptions& options,
                  const std::filesystem::path& out, Progress& progress);

}  // namespace terrane::tiler

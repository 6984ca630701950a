#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/mercator_grid.h"
#include "core/progress.h"
#include "ingest/dem.h"

namespace terrane::ingest {

struct MercatorOptions {
  int tile_px = 512;
  /// Finest zoom, 0 to 22; none: the coarsest whose pixels are no larger than the DEM's cells, by
  /// more than a tenth.
  std::optional<int> zoom;
};

/// What was decided, for messages and for whoever repeats it.
struct MercatorPlan {
  MercatorTiles tiles;  ///< that the DEM reaches, of the finest zoom
  int tile_px = 512;
  std::string method;  ///< GDAL's name: bilinear, or average where the zoom is coarser than the DEM
  double west_deg = 0, south_deg = 0, east_deg = 0, north_deg = 0;  ///< of the DEM's samples
};

/// Chooses zoom, tiles and method for a DEM.
/// \throws InputError if the DEM has no CRS, or lies where web mercator ends; ConfigError if the
///         zoom is out of range or has too many pixels.
MercatorPlan plan_mercator(const Dem& dem, const MercatorOptions& options);

/// Brings a DEM onto the pixels of a web mercator pyramid, through GDAL's warper (see
/// warp_heights.h). Heights stay over what the DEM's are over.
///
/// \param file  GeoTIFF to write; it must stay until the heights are gone.
/// \throws InputError if the DEM cannot be read, OutputError if the file
///         cannot be written.
std::unique_ptr<MercatorHeights> resample_to_mercator(const Dem& dem, const MercatorPlan& plan,
                                                      const std::filesystem::path& file,
                                                      Progress& progress);

}  // namespace terrane::ingest

#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "core/geodetic_grid.h"
#include "core/height_statistics.h"
#include "core/progress.h"
#include "ingest/dem.h"
#include "ingest/geoid.h"

namespace terrane::ingest {

inline constexpr int kFinestZoom = 22;  ///< cells of 7 cm

struct ResampleOptions {
  /// Finest zoom, 0 to kFinestZoom; none: the coarsest whose cells are no larger than the DEM's, by
  /// more than a tenth.
  std::optional<int> zoom;
  /// Height in metres of what has no data, over what the DEM's heights are over.
  double fill_m = 0;
  /// What the DEM's heights are over; null: the ellipsoid. Must outlive the heights.
  const Geoid* geoid = nullptr;
  /// How near the surface between the posts shall be to the DEM's samples, in metres (fit_posts.h).
  double fit_to_m = std::numeric_limits<double>::infinity();
};

/// What was done, for messages and for whoever repeats it.
struct Resampling {
  GeodeticTiles tiles;  ///< that the DEM reaches, of the finest zoom
  std::string method;  ///< GDAL's name: bilinear, or average where the zoom is coarser than the DEM
  int ramp_cells = 0;  ///< that the heights beside the data take to go over to the fill
  Window posts;        ///< that get a height from the DEM or beside it
};

/// Chooses zoom, tiles and method for a DEM.
/// \throws InputError if the DEM has no CRS; ConfigError if the zoom is out of range.
Resampling plan_resampling(const Dem& dem, const HeightStatistics& statistics,
                           const ResampleOptions& options);

/// Brings a DEM onto the posts of the geodetic quadtree, through GDAL's warper.
///
/// Places go by the inverse of the DEM's own map, so that the terrain lies where it lies with every
/// other format; they are exact to 1/100 cell. Posts are then moved so that the surface between
/// them meets the DEM's samples, if the zoom is not coarser than the DEM. Every post gets a height:
/// voids of up to 64 cells are interpolated; beside the data its edge goes on for 32 cells, and
/// then down (or up) to options.fill_m (see fill_beside.h). The result is kept in a file.
///
/// \param dem   must outlive the heights.
/// \param file  GeoTIFF to write; it must stay until the heights are gone.
/// \throws InputError if the DEM cannot be read or no post gets a height, OutputError if the file
///         cannot be written.
std::unique_ptr<GeodeticHeights> resample(const Dem& dem, const Resampling& plan,
                                          const ResampleOptions& options,
                                          const std::filesystem::path& file, Progress& progress);

}  // namespace terrane::ingest

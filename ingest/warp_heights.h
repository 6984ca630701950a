#pragma once

#include <gdal_priv.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "core/progress.h"
#include "ingest/dem.h"
#include "ingest/grid_extent.h"

namespace terrane::ingest {

/// A raster that a DEM is to be brought onto.
struct WarpTarget {
  std::int64_t columns = 0, rows = 0;
  /// Place of a position in pixels from the raster's upper left corner; the middle of the first
  /// pixel is (0.5, 0.5). A latitude that is not finite: nowhere.
  std::function<LonLat(double column, double row)> place;
  std::string method;  ///< GDAL's name: bilinear or average
};

/// Resamples a DEM through GDAL's warper into a new GeoTIFF of floats, NaN where it has no data.
///
/// Places go by the inverse of the DEM's own map and not by an operation of GDAL's, so that the
/// terrain lies where it lies in every other format; they are exact to 1/100 cell.
///
/// \pre the DEM has a CRS; the caller holds a GdalScope.
/// \throws InputError if the DEM cannot be read, OutputError if the file cannot be written.
GDALDatasetUniquePtr warp_heights(const Dem& dem, const GridExtent& extent,
                                  const WarpTarget& target, const std::filesystem::path& file,
                                  Progress& progress);

}  // namespace terrane::ingest

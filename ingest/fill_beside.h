#pragma once

#include <gdal_priv.h>

namespace terrane::ingest {

/// How a raster of heights goes on where it has no data.
struct BesideOptions {
  double fill_m = 0;   ///< height far away from all data
  int kept_cells = 0;  ///< so far the heights of the nearest data go on
  int ramp_cells = 1;  ///< from there they go over to fill_m in as many cells
};

/// Gives heights to samples without data that are near some, so that no wall stands at the edge of
/// the data: steep as those are, no rounded mesh keeps within a tolerance of them.
///
/// Voids up to twice kept_cells wide are interpolated from their rims (GDALFillNodata). What is
/// farther from all data than kept_cells + ramp_cells keeps having none. Takes five bytes a sample
/// of memory.
/// \return false if GDAL fails.
bool fill_beside(GDALRasterBand& heights, const BesideOptions& options);

}  // namespace terrane::ingest

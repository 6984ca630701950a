#pragma once

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/height_grid.h"
#include "ingest/dem.h"
#include "ingest/gdal_scope.h"
#include "ingest/height_conversion.h"

namespace terrane::ingest {

/// GDAL's affine coefficients: x = t[0] + t[1] column + t[2] row, y = t[3] + t[4] column + t[5]
/// row.
using Geotransform = std::array<double, 6>;

/// What one file says about itself and its band of heights, options applied.
struct RasterFacts {
  GridShape shape;
  DemDescription description;  ///< without what belongs to the CRS and the spacing
  HeightConversion conversion;
  bool has_mask = false;                     ///< a mask or alpha band says where there is no data
  std::optional<Geotransform> geotransform;  ///< of the corners of samples, as GDAL has it
  OGRSpatialReference crs;                   ///< empty if the file has none
};

/// Looks at an open file and decides what to read from it.
///
/// \throws InputError if it is no DEM, or the user has to say more.
RasterFacts examine_raster(GDALDataset& dataset, const std::string& file,
                           const OpenOptions& options);

/// The band with the heights: the option's, else the only one.
/// \throws InputError if there are several, none, or what there is looks like an image.
GDALRasterBand& choose_band(GDALDataset& dataset, const std::string& file,
                            const std::optional<int>& wanted);

/// Heights of one file. Opens it when needed; close() frees its handle until the next read().
///
/// Thread-safe: a GdalScope lets one thread at a time into GDAL, whose data sets are not.
class RasterFile {
 public:
  /// \throws InputError if the file cannot be opened or is no DEM.
  RasterFile(const std::string& file, const OpenOptions& options);
  ~RasterFile();
  RasterFile(const RasterFile&) = delete;
  RasterFile& operator=(const RasterFile&) = delete;

  const std::string& file() const { return file_; }
  const RasterFacts& facts() const { return facts_; }

  /// Heights of a window of this file, in metres, NaN for no data.
  /// \throws InputError if it cannot be read there.
  HeightGrid read(const Window& window) const;

  void close() const;

 private:
  GDALRasterBand& open_band(const GdalScope& gdal) const;

  std::string file_;
  RasterFacts facts_;
  mutable GDALDatasetUniquePtr dataset_;
};

}  // namespace terrane::ingest

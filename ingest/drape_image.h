#pragma once

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/georeference.h"
#include "ingest/raster_file.h"

namespace terrane::ingest {

/// One image of a drape, and where grid positions of the DEM lie on it.
///
/// \pre a GdalScope lives wherever one is used.
class DrapeImage {
 public:
  /// \param place  of the DEM; must outlive the image.
  /// \throws InputError that names the file, if it is no image with a place.
  DrapeImage(const std::string& file, const Georeference& place);

  const std::string& file() const { return file_; }
  GridShape shape() const { return shape_; }

  /// Pixel coordinates (the middle of the first pixel is 0.5, 0.5) of grid positions; nothing where
  /// there is none.
  std::vector<std::optional<PlanPosition>> pixels_of(std::span<const GridPosition> positions) const;

  /// Adds the image's part to a picture of red, green, blue and alpha over some samples of the DEM.
  /// \param pixels_per_texel  of the image, to choose overviews and resampling by.
  /// \throws InputError if it cannot be read.
  void draw(GDALDataset& picture, const Window& samples, double pixels_per_texel);

  /// Shape, place and a hash of all its files (overviews and the parts of a mosaic too) as text; of
  /// a service, which has none, 256 x 256 of its pixels.
  std::string describe() const;

 private:
  struct Cut;
  static int transform(void* cut, int to_source, int count, double* x, double* y, double* z,
                       int* success);
  GDALDataset& level_for(double pixels_per_texel, double& factor);
  std::array<int, 4> bands() const;

  std::string file_;
  const Georeference& place_;
  std::vector<std::string> files_;  ///< that GDAL reads it from
  GDALDatasetUniquePtr dataset_;
  GridShape shape_;
  Geotransform to_pixel_;                                      ///< from the image's CRS
  std::unique_ptr<OGRCoordinateTransformation> to_image_crs_;  ///< from longitude and latitude
  std::map<int, GDALDatasetUniquePtr> overviews_;
};

}  // namespace terrane::ingest

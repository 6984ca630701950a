#pragma once

#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/height_source.h"
#include "ingest/raster_file.h"

namespace terrane::ingest {

/// One raster, or several as one grid.
///
/// GDAL's own virtual mosaic (gdalbuildvrt) is not used: it applies the first file's nodata, unit
/// and scale to all, and gaps between files without nodata become heights of zero.
class Mosaic final : public HeightSource {
 public:
  /// \throws InputError if a file cannot be opened or does not fit the first one.
  Mosaic(const std::vector<std::string>& sources, const OpenOptions& options);

  GridShape shape() const override { return shape_; }
  HeightGrid read(const Window& window) const override;

  /// Of the corner of sample (0, 0) of the whole; absent if the only file has none.
  const std::optional<Geotransform>& geotransform() const { return geotransform_; }

  /// In the order given: a later one hides an earlier one where both have heights.
  const std::vector<std::unique_ptr<RasterFile>>& files() const { return files_; }

 private:
  void place_files();
  void keep_open(std::size_t file) const;

  std::vector<std::unique_ptr<RasterFile>> files_;
  std::vector<Window> windows_;  ///< where each file lies in the whole
  GridShape shape_;
  std::optional<Geotransform> geotransform_;
  mutable std::mutex mutex_;
  mutable std::list<std::size_t> recent_;  ///< files that may be open, last used first
};

}  // namespace terrane::ingest

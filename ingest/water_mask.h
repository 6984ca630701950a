#pragma once

#include <memory>
#include <string>
#include <vector>

namespace terrane::ingest {

/// Where there is water, as terrain tiles carry it.
class WaterMask {
 public:
  virtual ~WaterMask() = default;

  /// Cells along a side of a mask.
  static constexpr int kCells = 256;

  /// The mask of a rectangle of longitudes and latitudes, row by row from the north-west: 255 is
  /// water, 0 land. One byte where all is the same.
  ///
  /// A cell is water if its middle is. Thread-safe.
  virtual std::string bytes(double west_deg, double south_deg, double east_deg,
                            double north_deg) const = 0;

  /// Changes whenever a polygon does.
  virtual std::string fingerprint() const = 0;
};

/// Reads polygons of water.
///
/// \param sources  files or anything else that GDAL opens as vectors, ":LAYER" after them where
/// they
///                 have several.
/// \throws InputError that names the layer, if it cannot be read, holds other geometries, or has no
///         place on Earth.
std::shared_ptr<const WaterMask> open_water_mask(const std::vector<std::string>& sources);

}  // namespace terrane::ingest

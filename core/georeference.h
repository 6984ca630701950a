#pragma once

#include <span>
#include <string>
#include <vector>

namespace terrane {

/// A place on the grid, counted in cells from sample (0, 0).
struct GridPosition {
  double column = 0;
  double row = 0;
};

/// A place on the WGS84 ellipsoid.
struct LonLat {
  double longitude_deg = 0;
  double latitude_deg = 0;
};

/// A place in the plane of the DEM's coordinate reference system, in the units of its axes
/// (x: easting or longitude, y: northing or latitude). Metres for a DEM without a CRS.
struct PlanPosition {
  double x = 0;
  double y = 0;
};

/// Where the samples of a DEM lie.
class Georeference {
 public:
  virtual ~Georeference() = default;

  /// The CRS as WKT 2; empty for a DEM without one, whose plan is plain metres.
  virtual const std::string& crs_wkt() const = 0;

  /// Place of a grid position in the plane of the CRS (the affine geotransform; sample centres).
  virtual PlanPosition to_plan(GridPosition position) const = 0;

  /// Longitude and latitude (WGS84) of each position; the same operation for every one.
  ///
  /// Thread-safe.
  /// \pre crs_wkt() is not empty.
  /// \throws InputError if a position cannot be transformed.
  virtual std::vector<LonLat> to_lon_lat(std::span<const GridPosition> positions) const = 0;
};

}  // namespace terrane

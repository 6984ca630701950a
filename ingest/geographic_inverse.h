#pragma once

#include <string>
#include <vector>

#include "core/georeference.h"
#include "core/height_grid.h"

namespace terrane::ingest {

/// A rectangle of longitudes and latitudes without a jump inside: west is below east, and either
/// may be beyond 180 degrees.
struct GeographicArea {
  double west_deg = 0, south_deg = 0, east_deg = 0, north_deg = 0;
};

/// Longitudes and latitudes to columns and rows: Newton's method on the DEM's own map.
class GeographicInverse {
 public:
  /// \param place  must outlive the inverse.
  /// \pre place has a CRS.
  GeographicInverse(const Georeference& place, GridShape shape);

  /// Longitudes without a jump over the data set.
  double unwrapped(double longitude_deg) const;

  /// What the data set covers, and 2 % more on each side.
  const GeographicArea& area() const { return area_; }
  std::string described() const;

  /// Columns and rows; x and y of the points are longitudes and latitudes.
  /// \pre the points lie in area().
  std::vector<PlanPosition> to_grid(const std::vector<PlanPosition>& points) const;

 private:
  struct Jet;

  std::vector<Jet> jets(const std::vector<GridPosition>& at) const;
  double last_column() const { return static_cast<double>(shape_.columns - 1); }
  double last_row() const { return static_cast<double>(shape_.rows - 1); }

  const Georeference& place_;
  GridShape shape_;
  double middle_deg_ = 0;
  GeographicArea area_;
};

}  // namespace terrane::ingest

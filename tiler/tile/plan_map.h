#pragma once

#include <optional>
#include <vector>

#include "core/georeference.h"
#include "core/height_grid.h"

namespace terrane::tiler {

/// From longitude and latitude (WGS84) to the plan of a DEM's CRS, for readers without PROJ: one
/// polynomial for x and one for y.
///
/// With u = (longitude - middle) / half and v the same for latitudes, both within [-1, 1], x is the
/// sum of x[k] u^i v^j over all i + j <= degree, in the order 1, u, v, u^2, u v, v^2, u^3, ...
struct PlanMap {
  int degree = 0;
  LonLat middle, half;
  std::vector<double> x, y;  ///< (degree + 1) (degree + 2) / 2 each, in units of the CRS
  double max_error = 0;      ///< largest distance found between samples of the fit, in those units

  /// Longitudes count without a jump about middle.
  PlanPosition at(LonLat place) const;
};

/// Fits the map of lowest degree, up to 9, that is good to 1/10,000 of the distance of two samples;
/// degree 9 if none is.
///
/// \return nothing where the plan is that of WGS84 longitudes and latitudes to that accuracy.
/// \pre place has a CRS.
std::optional<PlanMap> fit_plan_map(const Georeference& place, GridShape shape);

}  // namespace terrane::tiler

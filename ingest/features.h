#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/grid_features.h"
#include "core/progress.h"
#include "ingest/dem.h"

namespace terrane::ingest {

/// What a user wants kept. Each source is a file or anything else that GDAL opens as vectors, with
/// ":LAYER" after it where there are several.
struct FeatureOptions {
  std::vector<std::string> lines;  ///< of lines; of polygons, their rims
  std::vector<std::string> water;  ///< of polygons
  /// Of every water, over what the DEM's own heights are over; else that of its shore samples.
  std::optional<double> water_height_m;
  double plan_tolerance_m = 1;  ///< lines may be simplified by a part of this
  /// Of a mesh whose places are rounded to a lattice: lines stay away from samples and from each
  /// other by about an eighth of the tolerance, so that no triangle between them turns over.
  bool is_rounded = false;

  bool empty() const { return lines.empty() && water.empty(); }
};

/// Reads lines and water and lays them on the grid of a DEM, whose samples inside water become one
/// flat height each.
///
/// Places go from the layer's CRS to WGS84 by one operation and from there to the grid by the
/// inverse of the DEM's own, so that they come to lie where the DEM is; between equal CRS, or
/// without one on both sides, by the affine map alone.
///
/// \throws InputError that names the layer, if it cannot be read, has several layers and none is
///         named, holds other geometries, has no known CRS, or lies beside the DEM.
GridFeatures read_features(Dem& dem, const FeatureOptions& options, Progress& progress);

}  // namespace terrane::ingest

#pragma once

#include "core/georeference.h"
#include "ingest/dem.h"
#include "ingest/geographic_inverse.h"

namespace terrane::ingest {

/// Where on Earth a DEM lies, all of it.
struct GridExtent {
  /// West is from -180 on; east is beyond 180 where the DEM crosses that meridian.
  GeographicArea area;
  bool goes_round = false;  ///< the columns go once round the Earth, or the DEM holds a pole
  double spacing_deg = 0;   ///< smaller distance of neighbouring samples in the middle

  /// Columns are longitudes and rows latitudes, in equal steps.
  bool is_affine = false;
  LonLat middle;  ///< if so: at middle_column, middle_row
  double middle_column = 0, middle_row = 0;
  double column_deg = 0, row_deg = 0;
};

/// \pre the DEM has a CRS.
GridExtent extent_of(const Dem& dem);

}  // namespace terrane::ingest

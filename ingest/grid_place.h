#pragma once

#include <ogr_spatialref.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/georeference.h"
#include "core/height_grid.h"
#include "core/progress.h"
#include "ingest/datum_shift.h"
#include "ingest/raster_file.h"

namespace terrane::ingest {

/// A grid placed by an affine map and, with a CRS, on the Earth.
class GridPlace final : public Georeference {
 public:
  /// \param corner_transform  of sample corners: sample (c, r) has its centre at (c + 0.5, r +
  /// 0.5). \param datum_shift       null without a CRS.
  GridPlace(std::string name, const Geotransform& corner_transform, std::string crs_wkt,
            std::unique_ptr<DatumShift> datum_shift);

  const std::string& crs_wkt() const override { return crs_wkt_; }
  PlanPosition to_plan(GridPosition position) const override;
  std::vector<LonLat> to_lon_lat(std::span<const GridPosition> positions) const override;

 private:
  std::string name_;
  Geotransform transform_;
  std::string crs_wkt_;
  std::unique_ptr<DatumShift> datum_shift_;
};

/// Places a grid, and fills what \p description says about spacing and CRS.
///
/// Heights are handled elsewhere, so the vertical part of a CRS is dropped. A CRS without a way to
/// WGS84 counts as none. What is missing and how it was replaced goes to progress.note().
///
/// \param geotransform  of sample corners; without one, cells of 1 m with rows to the south.
/// \param asked_crs     what the user wants for CRS; empty if it is the file's.
/// \throws InputError if the user's CRS cannot place this grid.
std::unique_ptr<Georeference> place_grid(const std::string& name, GridShape shape,
                                         const std::optional<Geotransform>& geotransform,
                                         OGRSpatialReference crs, const std::string& asked_crs,
                                         DemDescription& description, Progress& progress);

}  // namespace terrane::ingest

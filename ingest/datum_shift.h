#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "core/georeference.h"

namespace terrane::ingest {

/// One coordinate operation from a CRS to longitude and latitude on WGS84.
///
/// PROJ and GDAL usually offer several for a pair of CRS and choose anew for every point or batch,
/// so that neighbours can land metres apart (23 m for NAD27 in North America, with an area of
/// interest too). Here the choice is made once, for the extent of a data
/// set, and depends on nothing but the CRS, that extent and the grids that PROJ has installed (the
/// network is never asked).
class DatumShift {
 public:
  /// A rectangle of longitudes and latitudes; east is below west across the date line.
  struct Area {
    double west_deg;
    double south_deg;
    double east_deg;
    double north_deg;
  };

  /// Finds the best operation that can transform all of \p probes, else the one that can most.
  ///
  /// \param crs_wkt  two-dimensional.
  /// \param axes     axes[0] and axes[1]: which axis of the CRS (1 or 2; negative: reversed) x and
  /// y
  ///                 of a plan position are, as GDAL's axis mapping has it.
  /// \param probes   positions spread over the data set, in units of the CRS.
  /// \return null if there is none: the CRS has no known place on Earth, or no probe lies where it
  /// is
  ///         defined.
  static std::unique_ptr<DatumShift> find(const std::string& crs_wkt, std::array<int, 2> axes,
                                          std::span<const PlanPosition> probes);

  ~DatumShift();

  /// Longitudes from -180 to 180. Infinite where a position cannot be transformed.
  ///
  /// Thread-safe; the same position gives the same bits at every call.
  std::vector<LonLat> to_lon_lat(std::span<const PlanPosition> positions) const;

  /// PROJ's name of the operation.
  const std::string& name() const { return name_; }

  /// Whether PROJ knows no relation of the two datums and takes them for the same: places can be
  /// hundreds of metres wrong.
  bool is_a_guess() const { return is_a_guess_; }

 private:
  struct Operation;
  static std::unique_ptr<DatumShift> find_in(const std::string& crs_wkt, std::array<int, 2> axes,
                                             std::span<const PlanPosition> probes,
                                             const Area* area);
  explicit DatumShift(std::unique_ptr<Operation> operation, std::array<int, 2> axes);

  std::unique_ptr<Operation> borrow() const;
  void give_back(std::unique_ptr<Operation> operation) const;

  std::array<int, 2> axes_;
  std::string name_;
  bool is_a_guess_ = false;
  std::unique_ptr<Operation> original_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Operation>> idle_;  ///< clones: PROJ objects serve one thread
};

}  // namespace terrane::ingest

#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/georeference.h"

namespace terrane::model {

/// Metres east and north of a place: the plan of a model.
///
/// With a place on Earth: a transverse Mercator projection of the WGS84 ellipsoid, true to scale
/// along the meridian through the place; 10 km beside it lengths are 1.2 parts in a million too
/// long. Without one: plan positions as they are. Heights are taken as they are, too, so that water
/// is level.
class PlanFrame {
 public:
  /// Plain plan positions.
  PlanFrame();
  explicit PlanFrame(LonLat origin);
  ~PlanFrame();
  PlanFrame(PlanFrame&&) noexcept;

  bool is_on_earth() const { return projection_ != nullptr; }

  /// \pre is_on_earth().
  PlanPosition from_lon_lat(LonLat place) const;
  LonLat to_lon_lat(PlanPosition position) const;

 private:
  struct Projection;
  std::unique_ptr<Projection> projection_;
};

/// Refuses a file whose places are of another kind than the model's.
/// \throws InputError that says how to give the box.
void require_same_kind(const std::string& name, const Georeference& place, const PlanFrame& frame);

/// Grid positions of a DEM as plan positions, and back.
class GridPlan {
 public:
  /// \pre all that is passed lives on.
  GridPlan(const Georeference& place, const PlanFrame& frame) : place_(place), frame_(frame) {}

  std::vector<PlanPosition> to_plan(std::span<const GridPosition> positions) const;

  /// Inverts to_plan() to better than a millionth of a cell.
  /// \throws InputError if it does not converge: far outside the DEM's CRS.
  std::vector<GridPosition> to_grid(std::span<const PlanPosition> positions) const;

 private:
  const Georeference& place_;
  const PlanFrame& frame_;
};

}  // namespace terrane::model

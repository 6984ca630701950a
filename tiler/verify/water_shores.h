#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/georeference.h"

namespace terrane::verify {

/// A body of water as its file has it: the outer shore and those of its islands, each closed
/// without repeating its first point. Longitudes (x) and latitudes (y) in degrees, or, for a DEM
/// without a CRS, its plan.
struct WaterArea {
  std::vector<std::vector<PlanPosition>> shores;
  std::optional<float> height_m = {};  ///< over the ellipsoid, where it is known
};

/// A rectangle of the plan.
struct PlanBox {
  double left = std::numeric_limits<double>::infinity(), right = -left, bottom = left, top = -left;

  void add(const PlanPosition& p);
  bool meets(const PlanBox& other) const;
};

/// One body of water, to be asked for many places. Thread-safe.
class WaterShore {
 public:
  /// \param farthest_m  up to here distances are told.
  WaterShore(const WaterArea& area, bool is_in_degrees, double farthest_m);

  struct Answer {
    bool is_inside = false;
    double shore_m = std::numeric_limits<double>::infinity();  ///< to the nearest shore
  };
  Answer ask(const PlanPosition& place) const;

  /// Beyond it, everything is outside and farther than farthest_m.
  const PlanBox& near_box() const { return near_box_; }

 private:
  struct Side {
    PlanPosition a, b;
  };
  /// Metres of a unit of x and of y.
  struct Scale {
    double x_m, y_m;
  };
  Scale scale_at(double y) const;
  std::size_t band_of(double y) const;
  static double distance_m(const PlanPosition& place, const Side& side, const Scale& scale);

  bool is_in_degrees_;
  double farthest_m_;
  PlanBox near_box_;
  std::vector<std::vector<Side>> bands_;  ///< the sides near a stripe of y, from bottom to top
};

/// All bodies of water of a DEM. Thread-safe.
class WaterShores {
 public:
  WaterShores(const Georeference& place, std::span<const WaterArea> areas, double farthest_m);

  /// Where a position of the grid lies. In several bodies: where it is farthest inside.
  struct Place {
    double inside_m = 0;  ///< so far from the shore in water; 0 on land
    double outside_m = std::numeric_limits<double>::infinity();  ///< so far on land; 0 in water
    std::vector<std::size_t> near;  ///< the bodies that it lies in, or nearer to than farthest_m
  };
  std::vector<Place> find(std::span<const GridPosition> positions) const;

 private:
  std::vector<PlanPosition> plan_of(std::span<const GridPosition> positions) const;

  const Georeference& place_;
  bool is_in_degrees_;
  std::vector<WaterShore> shores_;
};

}  // namespace terrane::verify

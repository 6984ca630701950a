#include "model/plan_frame.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <GeographicLib/TransverseMercator.hpp>
#include <cmath>

#include "core/errors.h"

namespace terrane::model {

struct PlanFrame::Projection {
  GeographicLib::TransverseMercator mercator{GeographicLib::Constants::WGS84_a(),
                                             GeographicLib::Constants::WGS84_f(), 1.0};
  double longitude_deg;
  double north_of_equator_m = 0;
};

PlanFrame::PlanFrame() = default;
PlanFrame::~PlanFrame() = default;
PlanFrame::PlanFrame(PlanFrame&&) noexcept = default;

PlanFrame::PlanFrame(LonLat origin) : projection_(std::make_unique<Projection>()) {
  projection_->longitude_deg = origin.longitude_deg;
  projection_->north_of_equator_m = from_lon_lat(origin).y;
}

PlanPosition PlanFrame::from_lon_lat(LonLat place) const {
  PlanPosition position;
  projection_->mercator.Forward(projection_->longitude_deg, place.latitude_deg, place.longitude_deg,
                                position.x, position.y);
  position.y -= projection_->north_of_equator_m;
  return position;
}

LonLat PlanFrame::to_lon_lat(PlanPosition position) const {
  LonLat place;
  projection_->mercator.Reverse(projection_->longitude_deg, position.x,
                                position.y + projection_->north_of_equator_m, place.latitude_deg,
                                place.longitude_deg);
  return place;
}

void require_same_kind(const std::string& name, const Georeference& place,
                       const PlanFrame& frame) {
  const bool is_on_earth = !place.crs_wkt().empty();
  if (is_on_earth == frame.is_on_earth()) return;
  throw InputError(fmt::format("{}: {}. Give the box in {}", name,
                               is_on_earth ? "has a CRS" : "has no CRS",
                               is_on_earth ? "degrees (west_deg ...)" : "metres (west_m ...)"));
}

std::vector<PlanPosition> GridPlan::to_plan(std::span<const GridPosition> positions) const {
  std::vector<PlanPosition> plan;
  plan.reserve(positions.size());
  if (!frame_.is_on_earth()) {
    for (const GridPosition p : positions) plan.push_back(place_.to_plan(p));
    return plan;
  }
  for (const LonLat p : place_.to_lon_lat(positions)) plan.push_back(frame_.from_lon_lat(p));
  return plan;
}

// The mapping is nearly affine: steps by the inverse of its slope at one place converge.
std::vector<GridPosition> GridPlan::to_grid(std::span<const PlanPosition> positions) const {
  constexpr double kEnough_cells = 1e-7;
  const std::vector<GridPosition> cell = {{0, 0}, {1, 0}, {0, 1}};
  const auto origin = to_plan(cell);
  Eigen::Matrix2d slope;
  slope << origin[1].x - origin[0].x, origin[2].x - origin[0].x,  //
      origin[1].y - origin[0].y, origin[2].y - origin[0].y;
  const Eigen::Matrix2d inverse = slope.inverse();
  std::vector<GridPosition> grid(positions.size());
  for (int round = 0; round < 30; ++round) {
    const auto here = to_plan(grid);
    double largest = 0;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const Eigen::Vector2d step =
          inverse * Eigen::Vector2d(positions[i].x - here[i].x, positions[i].y - here[i].y);
      grid[i].column += step.x();
      grid[i].row += step.y();
      largest = std::max(largest, step.cwiseAbs().maxCoeff());
    }
    if (largest < kEnough_cells) return grid;
    if (!std::isfinite(largest)) break;
  }
  throw InputError("the box reaches beyond where the DEM's CRS is defined. Make it smaller");
}

}  // namespace terrane::model

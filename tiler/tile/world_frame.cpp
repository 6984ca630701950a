#include "tiler/tile/world_frame.h"

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/LocalCartesian.hpp>

namespace terrane::tiler {

struct WorldFrame::Tangent {
  GeographicLib::LocalCartesian cartesian;
};

WorldFrame::WorldFrame(const Georeference& place, GridShape shape) : place_(place) {
  const GridPosition centre{static_cast<double>(shape.columns - 1) / 2,
                            static_cast<double>(shape.rows - 1) / 2};
  if (place.crs_wkt().empty()) {
    local_origin_ = place.to_plan(centre);
    return;
  }
  origin_ = place.to_lon_lat({&centre, 1}).front();
  tangent_ = std::make_unique<Tangent>(
      Tangent{GeographicLib::LocalCartesian(origin_.latitude_deg, origin_.longitude_deg)});
}

WorldFrame::~WorldFrame() = default;

std::vector<Plumb> WorldFrame::plumbs(std::span<const GridPosition> positions) const {
  std::vector<Plumb> result;
  result.reserve(positions.size());
  if (is_local()) {
    for (const GridPosition& position : positions) {
      const PlanPosition plan = place_.to_plan(position);
      result.push_back(
          {{plan.x - local_origin_.x, plan.y - local_origin_.y, 0}, Eigen::Vector3d::UnitZ()});
    }
    return result;
  }
  std::vector<double> rotation(9);
  for (const LonLat& at : place_.to_lon_lat(positions)) {
    Plumb plumb;
    tangent_->cartesian.Forward(at.latitude_deg, at.longitude_deg, 0, plumb.base.x(),
                                plumb.base.y(), plumb.base.z(), rotation);
    // columns of the rotation: the east, north and up of that place in the frame
    plumb.up = {rotation[2], rotation[5], rotation[8]};
    result.push_back(plumb);
  }
  return result;
}

std::array<double, 16> WorldFrame::to_ecef() const {
  Eigen::Vector3d centre;
  std::vector<double> r(9);
  GeographicLib::Geocentric::WGS84().Forward(origin_.latitude_deg, origin_.longitude_deg, 0,
                                             centre.x(), centre.y(), centre.z(), r);
  return {r[0], r[3], r[6], 0, r[1],       r[4],       r[7],       0,
          r[2], r[5], r[8], 0, centre.x(), centre.y(), centre.z(), 1};
}

}  // namespace terrane::tiler

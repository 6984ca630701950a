#include "tiler/verify/world.h"

#include <GeographicLib/Geocentric.hpp>

namespace terrane::verify {

World::World(const Frame& frame, const Georeference& place)
    : frame_(frame), place_(place), cartesian_(frame.latitude_deg, frame.longitude_deg, 0) {}

std::vector<Plumb> World::plumb_local(std::span<const GridPosition> positions) const {
  std::vector<Plumb> plumbs;
  plumbs.reserve(positions.size());
  for (const GridPosition& position : positions) {
    const PlanPosition plan = place_.to_plan(position);
    plumbs.push_back({{plan.x - frame_.x, plan.y - frame_.y, 0}, Eigen::Vector3d::UnitZ()});
  }
  return plumbs;
}

std::vector<Plumb> World::plumb(std::span<const GridPosition> positions) const {
  if (frame_.is_local) return plumb_local(positions);
  std::vector<Plumb> plumbs;
  plumbs.reserve(positions.size());
  std::vector<double> rotation(9);
  for (const LonLat& at : place_.to_lon_lat(positions)) {
    Plumb plumb;
    cartesian_.Forward(at.latitude_deg, at.longitude_deg, 0, plumb.base.x(), plumb.base.y(),
                       plumb.base.z(), rotation);
    // third column: the local vertical, seen in the frame
    plumb.up = {rotation[2], rotation[5], rotation[8]};
    plumbs.push_back(plumb);
  }
  return plumbs;
}

Eigen::Matrix4d World::to_ecef() const {
  std::vector<double> rotation(9);
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  GeographicLib::Geocentric::WGS84().Forward(frame_.latitude_deg, frame_.longitude_deg, 0,
                                             matrix(0, 3), matrix(1, 3), matrix(2, 3), rotation);
  for (int i = 0; i < 9; ++i) matrix(i / 3, i % 3) = rotation[static_cast<std::size_t>(i)];
  return matrix;
}

}  // namespace terrane::verify

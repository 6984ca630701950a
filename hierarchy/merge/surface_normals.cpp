#include "hierarchy/merge/surface_normals.h"

#include <Eigen/Geometry>

namespace terrane::hierarchy {

std::vector<Eigen::Vector3d> vertex_normals(std::span<const Eigen::Vector3d> points,
                                            std::span<const Corners> triangles) {
  std::vector<Eigen::Vector3d> normals(points.size(), Eigen::Vector3d::Zero());
  for (const Corners& c : triangles) {
    const Eigen::Vector3d& a = points[c[0]];
    const Eigen::Vector3d area = (points[c[1]] - a).cross(points[c[2]] - a);
    for (const std::uint32_t v : c) normals[v] += area;
  }
  for (Eigen::Vector3d& n : normals) {
    const double length = n.norm();
    n = length > 0 ? Eigen::Vector3d(n / length) : Eigen::Vector3d::UnitZ();
  }
  return normals;
}

}  // namespace terrane::hierarchy

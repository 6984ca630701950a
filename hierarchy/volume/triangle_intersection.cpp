#include "hierarchy/volume/triangle_intersection.h"

#include <Eigen/Geometry>

namespace terrane::hierarchy::volume {
namespace {

using Eigen::Vector3d;

/// Six times the volume over a triangle: its sign says on which side p lies.
double side(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& p) {
  return (b - a).cross(c - a).dot(p - a);
}

std::optional<Vector3d> pierce(const Vector3d& from, const Vector3d& to,
                               const std::array<Vector3d, 3>& t) {
  const double above = side(t[0], t[1], t[2], from), below = side(t[0], t[1], t[2], to);
  if ((above > 0) == (below > 0) || above == 0 || below == 0) return {};
  const double u = side(from, to, t[0], t[1]), v = side(from, to, t[1], t[2]),
               w = side(from, to, t[2], t[0]);
  const bool is_inside = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
  if (!is_inside) return {};
  return from + (to - from) * (above / (above - below));
}

}  // namespace

std::optional<Vector3d> crossing(const std::array<Vector3d, 3>& a,
                                 const std::array<Vector3d, 3>& b) {
  for (int k = 0; k < 3; ++k) {
    if (const auto at = pierce(a[k], a[(k + 1) % 3], b)) return at;
    if (const auto at = pierce(b[k], b[(k + 1) % 3], a)) return at;
  }
  return {};
}

}  // namespace terrane::hierarchy::volume

#include "tiler/geodetic/horizon.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace terrane::tiler {
namespace {

const Eigen::Vector3d kRadii_m(6378137, 6378137, 6356752.314245179);

// seen from wherever a camera of a globe is
constexpr double kFarOut = 1000;

/// How far out along a direction a point must be to be seen with a point of scaled space; infinite
/// if it is never hidden with it.
double magnitude(const Eigen::Vector3d& scaled, const Eigen::Vector3d& direction) {
  // below the ellipsoid counts as on it
  const double length = std::max(1.0, scaled.norm());
  const Eigen::Vector3d unit = scaled.normalized();
  const double cos_alpha = unit.dot(direction), sin_alpha = unit.cross(direction).norm();
  const double cos_beta = 1 / length;
  const double sin_beta = std::sqrt(length * length - 1) * cos_beta;
  const double denominator = cos_alpha * cos_beta - sin_alpha * sin_beta;
  return denominator > 0 ? 1 / denominator : INFINITY;
}

}  // namespace

Sphere sphere_around(std::span<const Eigen::Vector3d> ecef) {
  Eigen::Vector3d low = ecef.front(), high = low;
  for (const Eigen::Vector3d& at : ecef) {
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  Sphere sphere{(low + high) / 2};
  for (const Eigen::Vector3d& at : ecef) {
    sphere.radius_m = std::max(sphere.radius_m, (at - sphere.centre).norm());
  }
  // decoders work in single precision relative to the centre, and their ellipsoid is rounded
  constexpr double kRoom = 1e-6, kRoom_m = 0.01;
  sphere.radius_m += kRoom * sphere.radius_m + kRoom_m;
  return sphere;
}

Eigen::Vector3d horizon_occlusion_point(std::span<const Eigen::Vector3d> ecef,
                                        const Eigen::Vector3d& towards) {
  const Eigen::Vector3d direction = towards.cwiseQuotient(kRadii_m).normalized();
  double farthest = 0;
  for (const Eigen::Vector3d& at : ecef) {
    farthest = std::max(farthest, magnitude(at.cwiseQuotient(kRadii_m), direction));
  }
  return direction * std::min(farthest, kFarOut);
}

}  // namespace terrane::tiler

#pragma once

#include <Eigen/Core>
#include <span>

namespace terrane::tiler {

/// A sphere in Earth-centred metres.
struct Sphere {
  Eigen::Vector3d centre;
  double radius_m = 0;
};

/// A sphere around points; it contains each of them by a little more than rounding.
/// \pre there is a point.
Sphere sphere_around(std::span<const Eigen::Vector3d> ecef);

/// Point that is seen above the horizon of the WGS84 ellipsoid whenever any of the points is, in
/// the space in which the ellipsoid is the unit sphere.
///
/// It lies in the direction of \p towards. Where there is none (the points go too far round the
/// Earth), it is so far out that it is seen from everywhere: zeros would hide the tile for ever.
/// \par Source
/// Cesium's quantized-mesh specification; the geometry is that of "Computing the horizon occlusion
/// point" (Cozzi and Ring, 2013).
Eigen::Vector3d horizon_occlusion_point(std::span<const Eigen::Vector3d> ecef,
                                        const Eigen::Vector3d& towards);

}  // namespace terrane::tiler

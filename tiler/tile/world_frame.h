#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "core/georeference.h"
#include "core/height_grid.h"

namespace terrane::tiler {

/// Where a sample may stand: at base + height * up.
struct Plumb {
  Eigen::Vector3d base;  ///< on the ellipsoid (height 0), in world metres
  Eigen::Vector3d up;    ///< unit normal of the ellipsoid
};

/// The Cartesian frame of a data set: east, north, up in metres about its centre (WGS84 tangent
/// plane), or the plain metres of a DEM without a CRS.
class WorldFrame {
 public:
  /// \param place  must outlive the frame.
  /// \throws InputError if the centre of the DEM has no longitude and latitude.
  WorldFrame(const Georeference& place, GridShape shape);
  ~WorldFrame();

  /// The exact plumb line through each grid position. Thread-safe.
  std::vector<Plumb> plumbs(std::span<const GridPosition> positions) const;

  bool is_local() const { return tangent_ == nullptr; }
  LonLat origin() const { return origin_; }                    ///< \pre !is_local()
  PlanPosition local_origin() const { return local_origin_; }  ///< \pre is_local()

  /// East-north-up to Earth-centred, column by column as glTF and 3D Tiles want it.
  /// \pre !is_local()
  std::array<double, 16> to_ecef() const;

 private:
  struct Tangent;

  const Georeference& place_;
  LonLat origin_;
  PlanPosition local_origin_;
  std::unique_ptr<const Tangent> tangent_;
};

}  // namespace terrane::tiler

#pragma once

#include <Eigen/Core>
#include <GeographicLib/LocalCartesian.hpp>
#include <span>
#include <vector>

#include "core/georeference.h"
#include "tiler/verify/output.h"

namespace terrane::verify {

/// The vertical of a grid position: height h stands at base + h * up.
struct Plumb {
  Eigen::Vector3d base;  ///< world place of height 0, metres
  Eigen::Vector3d up;    ///< unit normal of the ellipsoid there
};

/// Where grid positions stand in the world frame of an output.
class World {
 public:
  World(const Frame& frame, const Georeference& place);

  /// The exact vertical of each position. Thread-safe.
  std::vector<Plumb> plumb(std::span<const GridPosition> positions) const;

  /// The frame's matrix to ECEF; 3D Tiles wants it as the root's transform.
  /// \pre the frame is not local.
  Eigen::Matrix4d to_ecef() const;

 private:
  std::vector<Plumb> plumb_local(std::span<const GridPosition> positions) const;

  Frame frame_;
  const Georeference& place_;
  GeographicLib::LocalCartesian cartesian_;
};

}  // namespace terrane::verify

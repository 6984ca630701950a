#pragma once

#include <Eigen/Core>
#include <functional>

#include "hierarchy/volume/material.h"
#include "hierarchy/volume/tetra_geometry.h"

namespace terrane::hierarchy::volume {

/// A linear function over one tetrahedron.
struct LinearCell {
  TetraCorners corners;
  Eigen::Vector4d values;  ///< at the corners
};

/// Whether a ball can hold points of the material in question; empty: yes, every one.
using MayHold = std::function<bool(const Eigen::Vector3d& centre, double radius)>;

/// A quantity over the box (density, temperature, age, ...), with a function for each material.
///
/// Thread-safe: reading changes nothing.
class Field {
 public:
  virtual ~Field() = default;

  /// Value that a material has at a place. At an interface: the limit from inside the material.
  /// Beyond the material any continuation.
  virtual double value(const Eigen::Vector3d& p, MaterialId material) const = 0;

  /// Upper bound of |value - approximation| over the places of a tetrahedron that the material
  /// can hold; what an approximation costs. Never below 0.
  ///
  /// \param good_enough  a bound up to this one need not be made tighter.
  virtual double largest_deviation(const LinearCell& approximation, MaterialId material,
                                   const MayHold& may_hold, double good_enough) const = 0;
};

}  // namespace terrane::hierarchy::volume

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "tiler/tile/tile_frame.h"

namespace terrane::tiler {

/// The heights at which the plumb lines of a row of samples meet a plane: each a quotient of two
/// polynomials in the column, and so many times cheaper than a ray and a triangle.
///
/// Nothing tells whether a plumb line meets the triangle that the plane is of.
class PlaneAlongRow {
 public:
  /// \param point   any of the plane, in the world.
  /// \param normal  upright on it, of any length but 0.
  PlaneAlongRow(const TileFrame::Row& row, const Eigen::Vector3d& point,
                const Eigen::Vector3d& normal);

  /// Raises errors to how far the plane is from some samples of the row, one after the other.
  ///
  /// The same bits on any machine.
  /// \param first_column  of the first sample, in the tile.
  /// \param heights_m     NaN: a sample without data, whose error stays.
  /// \param worst_m       one for each height.
  void raise_errors(std::int64_t first_column, std::span<const float> heights_m,
                    std::span<double> worst_m) const;

 private:
  struct Raising;

  TileFrame::AlongRow above_;  // the plane over the plumb line's base, times what up_ is
  TileFrame::AlongRow up_;
};

}  // namespace terrane::tiler

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "hierarchy/collapse/field_plane.h"

namespace terrane::hierarchy {

/// The plane of a triangle half of its way from one place to another.
///
/// A corner is as far over it at one end of its way as it is under it at the other, and in between
/// nearer: so at no time is any of the triangle farther from it than the farthest of the corners.
struct HalfwayPlane {
  FieldPlane plane;
  double farthest_m = 0;  ///< vertical distance of a corner at either end

  HalfwayPlane(const std::array<FieldPoint, 3>& from, const std::array<FieldPoint, 3>& to)
      : plane(midpoint(from[0], to[0]), midpoint(from[1], to[1]), midpoint(from[2], to[2])) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double off_m = from[k].height_m - plane.height_m(from[k].column, from[k].row);
      farthest_m = std::max(farthest_m, std::abs(off_m));
    }
  }

 private:
  static FieldPoint midpoint(const FieldPoint& a, const FieldPoint& b) {
    return {(a.column + b.column) / 2, (a.row + b.row) / 2, (a.height_m + b.height_m) / 2};
  }
};

}  // namespace terrane::hierarchy

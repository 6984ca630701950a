#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "hierarchy/collapse/sample_field.h"

namespace terrane::hierarchy {

/// The plane of a triangle half of the way, over the grid and from its first corner at t = 0 on.
///
/// A corner is as far over it at one end of its way as it is under it at the other, and in between
/// nearer: so at no time is any of the triangle farther from it than the farthest of the corners.
struct HalfwayPlane {
  double height_m, per_column_m, per_row_m;  ///< NaN or infinite where it has no area there
  double farthest_m;                         ///< vertical distance of a corner at either end

  HalfwayPlane(const std::array<FieldPoint, 3>& from, const std::array<FieldPoint, 3>& to) {
    std::array<FieldPoint, 3> half;
    for (std::size_t k = 0; k < 3; ++k) {
      half[k] = {(from[k].column + to[k].column) / 2 - from[0].column,
                 (from[k].row + to[k].row) / 2 - from[0].row,
                 (from[k].height_m + to[k].height_m) / 2 - from[0].height_m};
    }
    const double bx = half[1].column - half[0].column, by = half[1].row - half[0].row;
    const double cx = half[2].column - half[0].column, cy = half[2].row - half[0].row;
    const double bz = half[1].height_m - half[0].height_m;
    const double cz = half[2].height_m - half[0].height_m;
    const double scale = 1 / (bx * cy - by * cx);
    per_column_m = (bz * cy - by * cz) * scale;
    per_row_m = (bx * cz - bz * cx) * scale;
    height_m = half[0].height_m - half[0].column * per_column_m - half[0].row * per_row_m;
    farthest_m = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      farthest_m = std::max(farthest_m, std::abs((to[k].height_m - from[k].height_m) -
                                                 (to[k].column - from[k].column) * per_column_m -
                                                 (to[k].row - from[k].row) * per_row_m) /
                                            2);
    }
  }
};

}  // namespace terrane::hierarchy

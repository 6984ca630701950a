#pragma once

#include "hierarchy/collapse/covered_samples.h"
#include "hierarchy/collapse/terrain_mesh.h"

namespace terrane::hierarchy {

/// The plane of a triangle over the grid.
class TrianglePlane {
 public:
  /// \pre the corners span an area in plan.
  TrianglePlane(const Place& a, const Place& b, const Place& c)
      : column_(column_of(a.plan)), row_(row_of(a.plan)), height_m_(a.height_m) {
    const double bx = column_of(b.plan) - column_, by = row_of(b.plan) - row_;
    const double cx = column_of(c.plan) - column_, cy = row_of(c.plan) - row_;
    const double bz = b.height_m - height_m_, cz = c.height_m - height_m_;
    const double scale = 1 / (bx * cy - by * cx);
    per_column_ = (bz * cy - by * cz) * scale;
    per_row_ = (bx * cz - bz * cx) * scale;
  }

  /// Height of the plane over a sample.
  double error_m(const CoveredSample& sample) const {
    return height_m_ + (sample.column - column_) * per_column_ + (sample.row - row_) * per_row_ -
           sample.height_m;
  }

  /// The square of what the plane rises over one cell along its steepest line.
  double squared_rise_m2() const { return per_column_ * per_column_ + per_row_ * per_row_; }

 private:
  double column_, row_, height_m_, per_column_, per_row_;
};

}  // namespace terrane::hierarchy

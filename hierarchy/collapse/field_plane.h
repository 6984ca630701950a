#pragma once

#include "hierarchy/collapse/sample_field.h"

namespace terrane::hierarchy {

/// The plane through three points over a field. Slopes are in metres per cell; they are NaN or
/// infinite where the points span no area in plan.
class FieldPlane {
 public:
  FieldPlane(const FieldPoint& a, const FieldPoint& b, const FieldPoint& c) : at_(a) {
    const double bx = b.column - a.column, by = b.row - a.row;
    const double cx = c.column - a.column, cy = c.row - a.row;
    const double bz = b.height_m - a.height_m, cz = c.height_m - a.height_m;
    const double area = bx * cy - by * cx;
    per_column_m_ = (bz * cy - cz * by) / area;
    per_row_m_ = (bx * cz - cx * bz) / area;
  }

  double per_column_m() const { return per_column_m_; }
  double per_row_m() const { return per_row_m_; }
  double height_m(double column, double row) const {
    return at_.height_m + (column - at_.column) * per_column_m_ + (row - at_.row) * per_row_m_;
  }

 private:
  FieldPoint at_;
  double per_column_m_, per_row_m_;
};

}  // namespace terrane::hierarchy

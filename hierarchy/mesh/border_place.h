#pragma once

#include <cmath>
#include <compare>

#include "core/georeference.h"
#include "hierarchy/mesh/grid_triangles.h"

namespace terrane::hierarchy {

/// Where a vertex of an outline or a seam stands on the grid of the DEM, which tells it from all
/// others: at a sample, or, if a line brought it, between samples. Exact: a multiple of
/// 1/kUnitsPerCell cells.
struct BorderPlace {
  double column = -1;  ///< negative: the vertex is on no border
  double row = -1;

  BorderPlace() = default;
  BorderPlace(double column_cells, double row_cells) : column(column_cells), row(row_cells) {}
  BorderPlace(const SampleId& sample) : column(sample.column), row(sample.row) {}

  bool is_none() const { return column < 0; }
  bool is_sample() const {
    return !is_none() && column == std::floor(column) && row == std::floor(row);
  }
  /// \pre is_sample().
  SampleId sample() const {
    return {static_cast<std::int32_t>(column), static_cast<std::int32_t>(row)};
  }
  GridPosition position() const { return {column, row}; }

  bool operator==(const BorderPlace&) const = default;
};

}  // namespace terrane::hierarchy

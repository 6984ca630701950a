#pragma once

#include <cstdint>

namespace terrane::hierarchy {

/// Grid units per cell: fine enough that a written (rounded) position is known to a small part of
/// its lattice step, coarse enough that orient2d() is exact over 32,768 cells.
inline constexpr std::int32_t kUnitsPerCell = 1 << 14;

/// A place in plan, in 1/kUnitsPerCell cells from a tile's first sample: x along the columns, y
/// *against* the rows, so that counter-clockwise is what a map shows for a north-up DEM.
struct GridPoint {
  std::int32_t x = 0;
  std::int32_t y = 0;

  bool operator==(const GridPoint&) const = default;
};

inline double column_of(GridPoint p) { return static_cast<double>(p.x) / kUnitsPerCell; }
inline double row_of(GridPoint p) { return static_cast<double>(-p.y) / kUnitsPerCell; }

/// Twice the signed area of a triangle in square grid units: positive if counter-clockwise. Exact.
inline std::int64_t orient2d(GridPoint a, GridPoint b, GridPoint c) {
  const std::int64_t abx = std::int64_t{b.x} - a.x, aby = std::int64_t{b.y} - a.y;
  const std::int64_t acx = std::int64_t{c.x} - a.x, acy = std::int64_t{c.y} - a.y;
  return abx * acy - aby * acx;
}

}  // namespace terrane::hierarchy

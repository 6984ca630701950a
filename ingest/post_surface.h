#pragma once

#include <array>
#include <cstdint>

#include "core/geodetic_grid.h"

namespace terrane::ingest {

/// The flat triangles between the posts of a zoom that its tiles begin from: diagonals run from a
/// cell's north-west corner to its south-east one, but through the corner of the tile in the cells
/// at its corners.
///
/// A place on it, as the share that each corner of the place's cell has.
struct PlaceOnSurface {
  std::int64_t column = 0, row = 0;  ///< of the cell's north-west corner, in posts
  std::array<double, 4> share{};     ///< north-west, south-west, south-east, north-east; sum 1
};

/// \param rows  of posts from pole to pole.
PlaceOnSurface on_surface(double column, double row, std::int64_t rows);

}  // namespace terrane::ingest

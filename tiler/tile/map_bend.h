#pragma once

#include <Eigen/Core>

#include "core/height_grid.h"
#include "tiler/tile/tile_frame.h"

namespace terrane::tiler {

/// How much the map of a tile bends in plan: a line that is straight over the grid lies beside the
/// straight one in the world by an eighth of its length squared times the second derivative.
class MapBend {
 public:
  MapBend(const TileFrame& frame, const Window& tile);

  /// Is one of the tile's border rows a single place? Triangles there have other samples than over
  /// the grid, or none.
  bool meets_pole() const { return meets_pole_; }

  /// The most that an edge of so many columns and rows may lie beside, in cells.
  double cells(double columns, double rows) const;

 private:
  void add(const TileFrame& frame, double column, double row, double u, double v);

  double columns_ = 0, both_ = 0, rows_ = 0;  // largest second derivatives, 1 / cell
  bool meets_pole_ = false;
};

}  // namespace terrane::tiler

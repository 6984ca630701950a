#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/georeference.h"
#include "core/height_grid.h"
#include "tiler/verify/world.h"

namespace terrane::verify {

/// Finds the grid position that a world point stands over.
///
/// Works on a table of exact verticals, linear in between: good to a fraction of a cell, enough to
/// know which samples a triangle may cover. refine() makes a few positions exact.
class GridLocator {
 public:
  struct Located {
    GridPosition at;
    Eigen::Vector3d up;  ///< the vertical there
  };

  /// \param window  samples around which points will be asked for; at least 2 x 2.
  GridLocator(const World& world, const Window& window);

  Located locate(const Eigen::Vector3d& point) const;

  /// Moves positions that locate() gave to within a millionth of a cell.
  /// \param points  the points they were found for, as many.
  void refine(std::span<const Eigen::Vector3d> points, std::span<GridPosition> positions) const;

  /// Metres from one column (row) to the next, in the middle of the window.
  double column_size_m() const { return column_size_m_; }
  double row_size_m() const { return row_size_m_; }

 private:
  /// base + height * up at a position, and how they change with column, row and height.
  struct Local {
    Eigen::Vector3d base, up;
    Eigen::Vector3d base_by_column, base_by_row, up_by_column, up_by_row;
  };
  Local local_at(const GridPosition& at) const;

  /// Column, row and height to go from (at, height) to reach a world offset.
  static Eigen::Vector3d step_to(const Local& local, double height, const Eigen::Vector3d& offset);

  const World& world_;
  GridPosition begin_;
  GridPosition spacing_;  // cells between nodes
  int node_columns_ = 0;
  int node_rows_ = 0;
  std::vector<Plumb> nodes_;
  double column_size_m_ = 0;
  double row_size_m_ = 0;
};

}  // namespace terrane::verify

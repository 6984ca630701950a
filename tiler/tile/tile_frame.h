#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "core/height_grid.h"
#include "hierarchy/collapse/terrain_mesh.h"
#include "tiler/tile/lattice.h"
#include "tiler/tile/world_frame.h"

namespace terrane::tiler {

/// The map between grid and world over one tile: polynomials in column and row that are exact to a
/// small part of the lattice's step, so that a position costs nanoseconds and not a projection.
///
/// Columns and rows are counted from the tile's first sample here.
class TileFrame final : public hierarchy::Placer {
 public:
  /// \param lattice  must outlive the frame.
  /// \throws InputError if the DEM's projection bends so much over the tile that no polynomial of
  ///         degree kHighestDegree follows it.
  TileFrame(const WorldFrame& world, const Lattice& lattice, const Window& window, int level);

  Plumb plumb(double column, double row) const;

  static constexpr int kHighestDegree = 12;

  /// A polynomial along a row, of column * per_column - 1.
  struct AlongRow {
    int degree = 0;
    double per_column = 0;
    std::array<double, kHighestDegree + 1> coefficients;  ///< of rising powers
  };

  /// The map along one row: cheaper than plumb() for many columns.
  class Row {
   public:
    Plumb plumb(double column) const;

    /// How far the bases of the plumb lines are along a direction, and what their upward
    /// directions have of it.
    AlongRow along_base(const Eigen::Vector3d& direction) const { return along(direction, 0); }
    AlongRow along_up(const Eigen::Vector3d& direction) const { return along(direction, 3); }

   private:
    friend class TileFrame;
    AlongRow along(const Eigen::Vector3d& direction, Eigen::Index first_value) const;

    double half_columns_ = 0;
    Eigen::Matrix<double, 6, Eigen::Dynamic> coefficients_;  // of the powers of the column
  };
  Row row(double row) const;

  /// Depth in metres below the tile's tangent plane at which the ellipsoid lies: what must be taken
  /// from a height so that a flat triangle becomes linear over the grid.
  double drop_m(double column, double row) const {
    const double x = column - half_columns_, y = row - half_rows_;
    return curvature_[0] * x * x + curvature_[1] * x * y + curvature_[2] * y * y;
  }

  /// The place over the grid at which a lattice point of this level stands.
  hierarchy::Place place_of(const LatticePoint& point) const;
  /// The same for a lattice point of the next finer level.
  hierarchy::Place place_of_finer(const LatticePoint& point) const;

  hierarchy::Place place(hierarchy::GridPoint plan, double height_m) const override;
  double over_datum_m(hierarchy::GridPoint plan, double height_m) const override;
  double bend_m(const hierarchy::Place& a, const hierarchy::Place& b) const override;
  bool is_straight(const hierarchy::Place& a, const hierarchy::Place& b) const override;
  double longest_straight_units() const override { return longest_straight_units_; }
  void look_down(std::span<const hierarchy::Place> places,
                 std::span<hierarchy::PlanPoint> seen) const override;

  /// Largest distance to the exact map that was found, doubled.
  double accuracy_m() const { return accuracy_m_; }
  /// Smaller distance between neighbouring samples along a row or a column, in metres.
  double spacing_m() const { return spacing_m_; }

 private:
  bool fit(const WorldFrame& world, const Window& window, int degree, double wanted_accuracy_m);
  void derive(const Window& window);
  double longest_straight_m() const;
  hierarchy::Place solve(const Eigen::Vector3d& at) const;
  hierarchy::Place place_of(const Lattice::OverGrid& at) const;

  const Lattice& lattice_;
  int level_;
  double first_column_, first_row_;  // of the tile in the grid
  double half_columns_, half_rows_;  // also the middle, as columns run from 0
  int degree_ = 0;
  /// 6 x (degree + 1)^2: base and up, powers of the column fastest
  Eigen::Matrix<double, 6, Eigen::Dynamic> coefficients_;
  Eigen::Matrix3d grid_per_world_;  // (column, row, height) per metre at the middle
  Eigen::Vector3d along_row_;       // that columns grow along, at the middle
  double handedness_ = 1;           // -1 if the grid is mirrored
  Eigen::Vector3d curvature_;       // of the drop: column^2, column row, row^2
  double accuracy_m_ = 0;
  double spacing_m_ = 0;
  double longest_straight_units_ = 0;
};

}  // namespace terrane::tiler

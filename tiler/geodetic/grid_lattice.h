#pragma once

#include <vector>

#include "core/geodetic_grid.h"
#include "tiler/tile/lattice.h"
#include "tiler/tile/world_frame.h"

namespace terrane::tiler {

/// Steps along a side of a quantized-mesh tile: u and v run from 0 to this.
inline constexpr std::int64_t kTileSteps = 32767;

/// The lattice of quantized-mesh: kTileSteps steps a tile in plan, and steps of a power of two of
/// metres over the ellipsoid. i grows eastward, j northward from the band's north-west corner; the
/// borders of tiles are multiples of kTileSteps on both sides.
///
/// A level's steps in plan are twice those of the finer one, so its points are on that one, too.
class GridLattice final : public Lattice {
 public:
  /// \param world        of the band; must outlive the lattice.
  /// \param tolerance_m  of each level: a step of height is a sixteenth of it at most, as far as
  ///                     kTileSteps steps hold the range of all heights.
  /// \throws ConfigError if the steps of height cannot hold the tolerance.
  GridLattice(const GeodeticTiles& band, const WorldFrame& world, double min_height_m,
              double max_height_m, const std::vector<double>& tolerance_m);

  Eigen::Vector3d world(const LatticePoint& point, int level) const override;
  double smallest_altitude_steps() const override;
  LatticePoint of_sample(GridPosition sample, const Plumb& plumb, double height_m,
                         int level) const override;
  std::optional<OverGrid> over_grid(const LatticePoint& point, int level) const override;
  LatticePoint nearest_over_grid(const OverGrid& place, int level) const override;

 private:
  const WorldFrame& world_;
};

}  // namespace terrane::tiler

#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "core/grid_features.h"
#include "hierarchy/collapse/line_chains.h"
#include "hierarchy/mesh/grid_triangles.h"
#include "tiler/pyramid.h"
#include "tiler/tile/lattice.h"
#include "tiler/tile/water_areas.h"
#include "tiler/tile_id.h"

namespace terrane::tiler {

/// The lines and the water of a DEM, leaf tile by leaf tile.
class TileFeatures {
 public:
  /// \param features     must outlive this.
  /// \param tolerance_m  of each level.
  TileFeatures(const GridFeatures& features, const Pyramid& pyramid, const Lattice& lattice,
               const std::vector<double>& tolerance_m);

  /// What lines do in a leaf tile and on its border.
  std::span<const FeatureLine> lines_of(const TileId& leaf) const;

  /// The height of the water that a sample lies in; NaN on land.
  float water_m(const hierarchy::SampleId& sample) const;

  const WaterAreas& water() const { return water_; }

  /// How far lines may leave those of the next finer level, or at level 0 those that lines_of()
  /// gives: so much less than the level's tolerance that what earlier levels and rounding have
  /// taken is within it, too.
  hierarchy::LineTolerance tolerance(int level) const { return tolerances_[level]; }

 private:
  void add(const FeatureLine& line, std::size_t piece, std::int64_t cells);

  const GridFeatures& features_;
  WaterAreas water_;
  std::map<std::pair<std::int64_t, std::int64_t>, std::vector<FeatureLine>> lines_;  // by y, x
  std::vector<hierarchy::LineTolerance> tolerances_;
};

}  // namespace terrane::tiler

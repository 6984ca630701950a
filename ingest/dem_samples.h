#pragma once

#include <vector>

#include "core/geodetic_grid.h"
#include "core/loose_samples.h"
#include "ingest/dem.h"
#include "ingest/geoid.h"

namespace terrane::ingest {

/// The samples of a DEM by their place among the posts of a zoom, read block by block: memory grows
/// with the number of blocks alone.
///
/// Columns go beyond 360 degrees where a block crosses the meridian of 180 degrees.
class DemSamples {
 public:
  /// \param dem    must outlive this, and so must the geoid.
  /// \param geoid  what the DEM's heights are over, to count them over the ellipsoid; null: as they
  ///               are.
  /// \pre the DEM has a CRS.
  DemSamples(const Dem& dem, int zoom, const Geoid* geoid);

  std::size_t block_count() const { return blocks_.size(); }

  /// Those of one block with heights, row by row.
  std::vector<LooseSample> block(std::size_t k) const;

  /// Those from the window's first column and row to its last ones, in the order of their blocks.
  /// Thread-safe.
  std::vector<LooseSample> in(const Window& posts) const;

 private:
  struct Block {
    Window window;                                    ///< of the DEM
    double left = 0, right = 0, top = 0, bottom = 0;  ///< what it covers, in posts
  };
  Block bounds_of(const Window& window) const;
  std::vector<GridPosition> posts_of(const std::vector<LonLat>& places) const;

  const Dem& dem_;
  const Geoid* geoid_;
  GeodeticZoom zoom_;
  double around_;  // posts round the Earth
  std::vector<Block> blocks_;
};

}  // namespace terrane::ingest

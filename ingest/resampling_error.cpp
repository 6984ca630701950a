#include "ingest/resampling_error.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ingest/dem_samples.h"
#include "ingest/post_surface.h"

namespace terrane::ingest {
namespace {

/// The posts around some places on the surface between them.
Window around(const std::vector<PlaceOnSurface>& places) {
  const auto [left, right] = std::ranges::minmax(places, {}, &PlaceOnSurface::column);
  const auto [top, bottom] = std::ranges::minmax(places, {}, &PlaceOnSurface::row);
  return {left.column, top.row, right.column + 2 - left.column, bottom.row + 2 - top.row};
}

double height_m(const HeightGrid& grid, const PlaceOnSurface& at) {
  return at.share[0] * grid.at(at.column, at.row) + at.share[1] * grid.at(at.column, at.row + 1) +
         at.share[2] * grid.at(at.column + 1, at.row + 1) +
         at.share[3] * grid.at(at.column + 1, at.row);
}

}  // namespace

ResamplingError measure_resampling(const Dem& dem, const GeodeticHeights& heights,
                                   const Geoid* geoid) {
  const GeodeticZoom zoom{heights.tiles().zoom};
  const DemSamples samples(dem, zoom.zoom, geoid);
  ResamplingError error;
  double sum_m2 = 0;
  for (std::size_t k = 0; k < samples.block_count(); ++k) {
    const std::vector<LooseSample> block = samples.block(k);
    if (block.empty()) continue;
    std::vector<PlaceOnSurface> places;
    for (const LooseSample& sample : block) {
      places.push_back(
          on_surface(sample.column, sample.row, zoom.tiles_down() * kGeodeticTileCells + 1));
    }
    const HeightGrid posts = heights.read(zoom.zoom, around(places));
    for (std::size_t i = 0; i < block.size(); ++i) {
      const double off_m = std::abs(height_m(posts, places[i]) - block[i].height_m);
      error.max_m = std::max(error.max_m, off_m);
      sum_m2 += off_m * off_m;
      ++error.samples;
    }
  }
  error.rms_m = std::sqrt(sum_m2 / static_cast<double>(std::max<std::int64_t>(1, error.samples)));
  return error;
}

}  // namespace terrane::ingest

#include "ingest/resampling_error.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace terrane::ingest {
namespace {

/// Column and row among the posts of a zoom, from 180 W and the north pole.
GridPosition post_of(const GeodeticZoom& zoom, const LonLat& place) {
  return {(place.longitude_deg + 180) / zoom.cell_deg(),
          (90 - place.latitude_deg) / zoom.cell_deg()};
}

/// The posts around some positions.
Window around(const std::vector<GridPosition>& posts, const GeodeticZoom& zoom) {
  double left = INFINITY, right = -INFINITY, top = INFINITY, bottom = -INFINITY;
  for (const GridPosition& post : posts) {
    left = std::min(left, post.column);
    right = std::max(right, post.column);
    top = std::min(top, post.row);
    bottom = std::max(bottom, post.row);
  }
  const auto column = static_cast<std::int64_t>(std::floor(left));
  const std::int64_t last_row = zoom.tiles_down() * kGeodeticTileCells;
  const std::int64_t row = std::min(static_cast<std::int64_t>(std::floor(top)), last_row - 1);
  return {column, row, static_cast<std::int64_t>(std::floor(right)) + 2 - column,
          std::min(static_cast<std::int64_t>(std::floor(bottom)) + 1, last_row) + 1 - row};
}

double bilinear(const HeightGrid& grid, const GridPosition& post) {
  const std::int64_t last_row = grid.window.row + grid.window.rows - 1;
  const auto column = static_cast<std::int64_t>(std::floor(post.column));
  const std::int64_t row = std::min(static_cast<std::int64_t>(std::floor(post.row)), last_row - 1);
  const double x = post.column - static_cast<double>(column);
  const double y = post.row - static_cast<double>(row);
  const auto at = [&](std::int64_t c, std::int64_t r) {
    return double{grid.at(column + c, row + r)};
  };
  return (1 - y) * ((1 - x) * at(0, 0) + x * at(1, 0)) + y * ((1 - x) * at(0, 1) + x * at(1, 1));
}

}  // namespace

ResamplingError measure_resampling(const Dem& dem, const GeodeticHeights& heights,
                                   const Geoid* geoid) {
  constexpr std::int64_t kBlock = 128;
  const GeodeticZoom zoom{heights.tiles().zoom};
  const GridShape shape = dem.heights().shape();
  ResamplingError error;
  double sum_m2 = 0;
  for (std::int64_t row = 0; row < shape.rows; row += kBlock) {
    for (std::int64_t column = 0; column < shape.columns; column += kBlock) {
      const Window window{column, row, std::min(kBlock, shape.columns - column),
                          std::min(kBlock, shape.rows - row)};
      const HeightGrid grid = dem.heights().read(window);
      std::vector<GridPosition> samples;
      std::vector<double> heights_m;
      for (std::int64_t r = row; r < row + window.rows; ++r) {
        for (std::int64_t c = column; c < column + window.columns; ++c) {
          if (!grid.has_data(c, r)) continue;
          samples.push_back({static_cast<double>(c), static_cast<double>(r)});
          heights_m.push_back(grid.at(c, r));
        }
      }
      if (samples.empty()) continue;
      const std::vector<LonLat> places = dem.place().to_lon_lat(samples);
      std::vector<GridPosition> posts;
      for (const LonLat& place : places) {
        GridPosition post = post_of(zoom, place);
        // a block that crosses 180 degrees stays in one piece
        const double turn = static_cast<double>(zoom.tiles_around() * kGeodeticTileCells);
        if (!posts.empty()) {
          post.column =
              posts.front().column + std::remainder(post.column - posts.front().column, turn);
        }
        posts.push_back(post);
      }
      const HeightGrid resampled = heights.read(zoom.zoom, around(posts, zoom));
      for (std::size_t i = 0; i < posts.size(); ++i) {
        const double height_m =
            heights_m[i] + (geoid == nullptr ? 0 : geoid->undulation_m(places[i]));
        const double off_m = std::abs(bilinear(resampled, posts[i]) - height_m);
        error.max_m = std::max(error.max_m, off_m);
        sum_m2 += off_m * off_m;
        ++error.samples;
      }
    }
  }
  error.rms_m = std::sqrt(sum_m2 / static_cast<double>(std::max<std::int64_t>(1, error.samples)));
  return error;
}

}  // namespace terrane::ingest

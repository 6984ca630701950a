#include "tiler/geodetic/tile_band.h"

#include <fmt/format.h>

namespace terrane::tiler {

GridShape TileBand::shape() const {
  const Window posts = tiles_.posts();
  return {posts.columns, posts.rows};
}

HeightGrid TileBand::read(const Window& window) const {
  const Window posts = tiles_.posts();
  HeightGrid grid = heights_.read(
      tiles_.zoom,
      {posts.column + window.column, posts.row + window.row, window.columns, window.rows});
  grid.window = window;
  return grid;
}

std::vector<LooseSample> TileBand::in(const Window& window) const {
  const Window posts = tiles_.posts();
  std::vector<LooseSample> samples = heights_.dem_samples(
      {posts.column + window.column, posts.row + window.row, window.columns, window.rows});
  for (LooseSample& sample : samples) {
    sample.column -= static_cast<double>(posts.column);
    sample.row -= static_cast<double>(posts.row);
  }
  return samples;
}

const std::string& TileBand::crs_wkt() const {
  static const std::string wkt =
      "GEOGCRS[\"WGS 84\",DATUM[\"World Geodetic System 1984\",ELLIPSOID[\"WGS 84\",6378137,"
      "298.257223563]],CS[ellipsoidal,2],AXIS[\"longitude\",east],AXIS[\"latitude\",north],"
      "ANGLEUNIT[\"degree\",0.0174532925199433]]";
  return wkt;
}

PlanPosition TileBand::to_plan(GridPosition position) const {
  const GridPosition first{static_cast<double>(tiles_.posts().column),
                           static_cast<double>(tiles_.posts().row)};
  const LonLat at =
      GeodeticZoom{tiles_.zoom}.at({first.column + position.column, first.row + position.row});
  return {at.longitude_deg, at.latitude_deg};
}

std::vector<LonLat> TileBand::to_lon_lat(std::span<const GridPosition> positions) const {
  std::vector<LonLat> result;
  result.reserve(positions.size());
  for (const GridPosition& position : positions) {
    const PlanPosition at = to_plan(position);
    result.push_back({at.x, at.y});
  }
  return result;
}

std::string path_of(const TmsTile& tile) {
  return fmt::format("{}/{}/{}", tile.zoom, tile.x, tile.y);
}

TmsBounds bounds_of(const TmsTile& tile) {
  const double side_deg = GeodeticZoom{tile.zoom}.tile_deg();
  const auto x = static_cast<double>(tile.x), y = static_cast<double>(tile.y);
  return {-180 + x * side_deg, -90 + y * side_deg, -180 + (x + 1) * side_deg,
          -90 + (y + 1) * side_deg};
}

TmsTile tms_of(const TileId& tile, const GeodeticTiles& band) {
  const GeodeticZoom zoom{band.zoom - tile.level};
  const std::int64_t x = (band.x >> tile.level) + tile.x, y = (band.y >> tile.level) + tile.y;
  return {zoom.zoom, x % zoom.tiles_around(), zoom.tiles_down() - 1 - y};
}

}  // namespace terrane::tiler

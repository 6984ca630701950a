#include "tiler/geodetic/layer_json.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace terrane::tiler {
namespace {

using nlohmann::ordered_json;

/// Tiles from one corner to another, as clients count them.
struct Range {
  TmsTile first, last;
};

/// One range, or two where the tiles cross the meridian of 180 degrees.
std::vector<Range> ranges(const GeodeticTiles& tiles) {
  const GeodeticZoom zoom{tiles.zoom};
  const std::int64_t around = zoom.tiles_around();
  const std::int64_t south = zoom.tiles_down() - tiles.y - tiles.rows;
  const auto range = [&](std::int64_t first, std::int64_t last) {
    return Range{{tiles.zoom, first, south}, {tiles.zoom, last, south + tiles.rows - 1}};
  };
  const std::int64_t first = tiles.x % around, last = first + tiles.columns - 1;
  if (last < around) return {range(first, last)};
  if (tiles.columns == around) return {range(0, around - 1)};
  return {range(0, last - around), range(first, around - 1)};
}

ordered_json json_of(const std::vector<Range>& ranges) {
  ordered_json json = ordered_json::array();
  for (const auto& [first, last] : ranges) {
    json.push_back({{"startX", first.x}, {"startY", first.y}, {"endX", last.x}, {"endY", last.y}});
  }
  return json;
}

/// What of some ranges lies below a tile.
std::vector<Range> below(const TmsTile& tile, const std::vector<Range>& all) {
  std::vector<Range> result;
  for (const auto& [first, last] : all) {
    const int shift = first.zoom - tile.zoom;
    const TmsTile low{first.zoom, std::max(first.x, tile.x << shift),
                      std::max(first.y, tile.y << shift)};
    const TmsTile high{first.zoom, std::min(last.x, ((tile.x + 1) << shift) - 1),
                       std::min(last.y, ((tile.y + 1) << shift) - 1)};
    if (low.x <= high.x && low.y <= high.y) result.push_back({low, high});
  }
  return result;
}

}  // namespace

std::array<double, 4> bounds_deg(const GeodeticTiles& tiles) {
  const double side_deg = GeodeticZoom{tiles.zoom}.tile_deg();
  const auto meridian = [&](std::int64_t x) { return -180 + static_cast<double>(x) * side_deg; };
  const auto parallel = [&](std::int64_t y) { return 90 - static_cast<double>(y) * side_deg; };
  double west = meridian(tiles.x), east = meridian(tiles.x + tiles.columns);
  if (east > 180) west = -180, east = 180;
  return {west, parallel(tiles.y + tiles.rows), east, parallel(tiles.y)};
}

std::string layer_json(const TerrainLayer& layer) {
  ordered_json json;
  json["tilejson"] = "2.1.0";
  json["name"] = "terrane";
  json["version"] = "1.1.0";
  json["format"] = "quantized-mesh-1.0";
  json["scheme"] = "tms";
  json["projection"] = "EPSG:4326";
  json["attribution"] = layer.attribution;
  json["tiles"] = {"{z}/{x}/{y}.terrain?v=" + layer.version};
  json["extensions"] = {"octvertexnormals", "metadata"};
  if (layer.has_water) json["extensions"].push_back("watermask");
  json["metadataAvailability"] = kMetadataZooms;
  json["minzoom"] = 0;
  json["maxzoom"] = layer.available.size() - 1;
  json["bounds"] = bounds_deg(layer.available.back());
  json["available"] = ordered_json::array();
  for (const GeodeticTiles& tiles : layer.available) {
    json["available"].push_back(json_of(ranges(tiles)));
  }
  return json.dump(2) + "\n";
}

std::string tile_metadata(const TmsTile& tile, const std::vector<GeodeticTiles>& available) {
  if (tile.zoom % kMetadataZooms != 0) return {};
  ordered_json json{{"available", ordered_json::array()}};
  const int deepest = std::min(tile.zoom + kMetadataZooms, static_cast<int>(available.size()) - 1);
  for (int zoom = tile.zoom + 1; zoom <= deepest; ++zoom) {
    json["available"].push_back(
        json_of(below(tile, ranges(available[static_cast<std::size_t>(zoom)]))));
  }
  return json.dump();
}

}  // namespace terrane::tiler

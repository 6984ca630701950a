#include "tiler/verify/terrain_layer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tiler/verify/json_file.h"
#include "tiler/verify/terrain_tileset.h"

namespace terrane::verify {

using nlohmann::json;

double TerrainKey::side_deg() const { return std::ldexp(180.0, -zoom); }
double TerrainKey::west_deg() const { return -180 + static_cast<double>(x) * side_deg(); }
double TerrainKey::south_deg() const { return -90 + static_cast<double>(y) * side_deg(); }

std::string to_string(const TerrainKey& key) {
  return fmt::format("tile {}/{}/{}", key.zoom, key.x, key.y);
}

bool TerrainLayer::has(const TerrainKey& key) const {
  if (key.zoom < 0 || key.zoom > finest()) return false;
  return std::ranges::any_of(
      available[static_cast<std::size_t>(key.zoom)],
      [&](const TerrainRange& range) { return range.contains(key.x, key.y); });
}

std::string TerrainLayer::path_of(const TerrainKey& key) const {
  if (kind == TerrainKind::kQuantizedMesh) {
    return fmt::format("{}/{}/{}.terrain", key.zoom, key.x, key.y);
  }
  return address_of(content_template[static_cast<std::size_t>(key.x >> key.zoom)], key);
}

std::optional<TerrainKey> TerrainLayer::key_of(const std::string& path) const {
  // zoom, x and y are the last three names of a path, in both kinds
  const auto from = path.find_first_of("0123456789");
  TerrainKey key;
  long long x = 0, y = 0;
  if (from == std::string::npos ||
      std::sscanf(path.c_str() + from, "%d/%lld/%lld", &key.zoom, &x, &y) != 3 || key.zoom < 0 ||
      key.zoom > finest()) {
    return std::nullopt;
  }
  const std::int64_t side = std::int64_t{1} << key.zoom;
  for (const std::int64_t east : {std::int64_t{0}, side}) {
    key.x = x + east, key.y = y;
    if (key.x >= 0 && key.x < 2 * side && path_of(key) == path) return key;
  }
  return std::nullopt;
}

const char* TerrainLayer::extension() const {
  return kind == TerrainKind::kQuantizedMesh ? ".terrain" : ".glb";
}

double TerrainLayer::rounding_m(int zoom) const {
  // to a float of a height of kilometres; of a place, 2^-22 of the tile, as the format states
  constexpr double kOfHeight_m = 1e-3, kHalfAround_m = 20037508.34;
  if (kind == TerrainKind::kQuantizedMesh) return kOfHeight_m;
  return std::max(kOfHeight_m, std::ldexp(kHalfAround_m, -zoom - 22));
}

ZoomRanges ranges_of(const json& list) {
  ZoomRanges ranges;
  for (const json& range : list) {
    ranges.push_back({range.at("startX"), range.at("startY"), range.at("endX"), range.at("endY")});
  }
  return ranges;
}

namespace {

void read_listing_of_quantized_mesh(TerrainLayer& layer) {
  const auto file = layer.folder / "layer.json";
  read_json(file, [&](const json& document) {
    layer.format = document.value("format", "");
    layer.scheme = document.value("scheme", "");
    layer.projection = document.value("projection", "");
    layer.extensions = document.value("extensions", std::vector<std::string>());
    for (const json& ranges : document.at("available")) {
      layer.available.push_back(ranges_of(ranges));
    }
    const auto address = document.at("tiles").at(0).get<std::string>();
    if (address.substr(0, address.find('?')) != "{z}/{x}/{y}.terrain") {
      throw damaged(file, fmt::format("tiles are at '{}'", address));
    }
  });
}

void read_listing_of_3d_tiles(TerrainLayer& layer) {
  TerrainTileset tileset = read_terrain_tileset(layer.folder);
  layer.available = std::move(tileset.available);
  layer.content_template = std::move(tileset.content_template);
  layer.facts = std::move(tileset.facts);
  layer.faults_of_the_listing = std::move(tileset.faults);
}

}  // namespace

TerrainLayer read_terrain_layer(const std::filesystem::path& folder) {
  TerrainLayer layer{.folder = folder};
  const auto file = folder / "terrane.json";
  read_json(file, [&](const json& document) {
    if (document.value("tiles", "") == "3dtiles-terrain") layer.kind = TerrainKind::k3dTiles;
    for (const json& zoom : document.at("zooms")) {
      if (zoom.at("zoom") != layer.zooms.size()) {
        throw damaged(file, "zooms do not count from 0");
      }
      layer.zooms.push_back({.tolerance_m = zoom.at("tolerance_m"),
                             .max_error_m = zoom.at("max_error_m"),
                             .is_held_to_dem = zoom.at("held_to") == "DEM samples",
                             .tiles = zoom.at("tiles"),
                             .triangles = zoom.at("triangles"),
                             .bytes = zoom.at("bytes")});
    }
  });
  if (layer.kind == TerrainKind::kQuantizedMesh) {
    read_listing_of_quantized_mesh(layer);
  } else {
    read_listing_of_3d_tiles(layer);
  }
  if (layer.zooms.size() != layer.available.size() || layer.zooms.empty()) {
    throw damaged(file, fmt::format("has {} zooms, and tiles are listed of {}", layer.zooms.size(),
                                    layer.available.size()));
  }
  return layer;
}

}  // namespace terrane::verify

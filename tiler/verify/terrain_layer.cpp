#include "tiler/verify/terrain_layer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tiler/verify/json_file.h"

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

std::filesystem::path TerrainLayer::file_of(const TerrainKey& key) const {
  return folder / fmt::format("{}/{}/{}.terrain", key.zoom, key.x, key.y);
}

ZoomRanges ranges_of(const json& list) {
  ZoomRanges ranges;
  for (const json& range : list) {
    ranges.push_back({range.at("startX"), range.at("startY"), range.at("endX"), range.at("endY")});
  }
  return ranges;
}

TerrainLayer read_terrain_layer(const std::filesystem::path& folder) {
  TerrainLayer layer{.folder = folder};
  const auto file = folder / "layer.json";
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
  read_json(folder / "terrane.json", [&](const json& document) {
    for (const json& zoom : document.at("zooms")) {
      if (zoom.at("zoom") != layer.zooms.size()) {
        throw damaged(folder / "terrane.json", "zooms do not count from 0");
      }
      layer.zooms.push_back({.tolerance_m = zoom.at("tolerance_m"),
                             .max_error_m = zoom.at("max_error_m"),
                             .is_held_to_dem = zoom.at("held_to") == "DEM samples",
                             .tiles = zoom.at("tiles"),
                             .triangles = zoom.at("triangles"),
                             .bytes = zoom.at("bytes")});
    }
  });
  if (layer.zooms.size() != layer.available.size() || layer.zooms.empty()) {
    throw damaged(file, fmt::format("{} zooms are available, terrane.json has {}",
                                    layer.available.size(), layer.zooms.size()));
  }
  return layer;
}

}  // namespace terrane::verify

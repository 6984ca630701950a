#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tiler/verify/subtree.h"

namespace terrane::verify {

/// A tile of the geodetic quadtree: x eastward from 180 W, y northward from the south pole.
struct TerrainKey {
  int zoom = 0;
  std::int64_t x = 0, y = 0;

  auto operator<=>(const TerrainKey&) const = default;
  double side_deg() const;
  double west_deg() const;
  double south_deg() const;
};
std::string to_string(const TerrainKey& key);

/// Tiles from one corner to another, both among them.
struct TerrainRange {
  std::int64_t start_x = 0, start_y = 0, end_x = 0, end_y = 0;

  bool contains(std::int64_t x, std::int64_t y) const {
    return x >= start_x && x <= end_x && y >= start_y && y <= end_y;
  }
};
using ZoomRanges = std::vector<TerrainRange>;

/// How terrain tiles are written.
enum class TerrainKind {
  kQuantizedMesh,  ///< with a layer.json
  k3dTiles         ///< glb tiles, with a tileset.json and subtrees
};

/// What the listings and terrane.json say of a set of terrain tiles.
struct TerrainLayer {
  std::filesystem::path folder;
  TerrainKind kind = TerrainKind::kQuantizedMesh;
  std::vector<ZoomRanges> available;               ///< by zoom, from 0
  std::string format, scheme, projection;          ///< of layer.json
  std::vector<std::string> extensions;             ///< of layer.json
  std::array<std::string, 2> content_template;     ///< of tileset.json
  std::map<TerrainKey, TerrainFacts> facts;        ///< of the subtrees
  std::vector<std::string> faults_of_the_listing;  ///< a line each

  struct Zoom {
    double tolerance_m = 0, max_error_m = 0;
    bool is_held_to_dem = false;
    std::int64_t tiles = 0, triangles = 0, bytes = 0;
  };
  std::vector<Zoom> zooms;  ///< by zoom, from 0

  int finest() const { return static_cast<int>(available.size()) - 1; }
  bool has(const TerrainKey& key) const;
  std::string path_of(const TerrainKey& key) const;
  std::filesystem::path file_of(const TerrainKey& key) const { return folder / path_of(key); }
  /// The tile whose file has this path, whether it is listed or not.
  std::optional<TerrainKey> key_of(const std::string& path) const;
  /// ".terrain" or ".glb"
  const char* extension() const;

  /// What heights may be off by rounding alone: floats do not hold them more closely.
  double rounding_m(int zoom) const;
};

/// The ranges of one zoom, as layer.json and the metadata of tiles have them.
ZoomRanges ranges_of(const nlohmann::json& json);

/// \throws InputError if a file is missing or damaged, or if they have different zooms.
TerrainLayer read_terrain_layer(const std::filesystem::path& folder);

}  // namespace terrane::verify

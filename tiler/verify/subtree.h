#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

namespace terrane::verify {

/// A tile of a subtree, counted from the subtree's root: level downward.
struct SubtreeTile {
  int depth = 0;
  std::int64_t x = 0;
  std::int64_t y = 0;
  bool has_content = false;
  std::array<double, 12> box = {};  ///< of its metadata
  std::int64_t triangles = 0;
  std::int64_t bytes = 0;
  double max_error_m = 0;
};

struct Subtree {
  std::vector<SubtreeTile> tiles;                     ///< those that are there, in order
  std::vector<std::array<std::int64_t, 2>> children;  ///< x and y of the subtrees below it
};

/// Reads a .subtree file of a quadtree with the metadata that docs/formats.md describes.
///
/// \param box_property  name of the property with the semantic TILE_BOUNDING_BOX.
/// \throws InputError that names the file if it is missing or damaged.
Subtree read_subtree(const std::filesystem::path& file, int levels,
                     const std::string& box_property);

/// What the metadata of 3D Tiles terrain say of a tile.
struct TerrainFacts {
  double min_height_m = 0, max_height_m = 0;
  std::array<double, 3> sphere_centre{};
  double sphere_radius_m = 0;
  std::array<double, 3> horizon{};
};

/// The names that a schema has for what has a meaning: TILE_MINIMUM_HEIGHT and so on.
struct TerrainProperties {
  std::string min_height, max_height, bounding_sphere, horizon_occlusion_point;
};

/// The same of a quadtree of terrain.
struct TerrainSubtree {
  Subtree listing;                  ///< without boxes, numbers of triangles and the like
  std::vector<TerrainFacts> facts;  ///< of each of its tiles
};
TerrainSubtree read_terrain_subtree(const std::filesystem::path& file, int levels,
                                    const TerrainProperties& names);

}  // namespace terrane::verify

#include "tiler/geodetic/terrain_tileset.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace terrane::tiler {
namespace {

/// Reads a subtree: which tiles are there, and the lowest heights of each.
struct ReadSubtree {
  nlohmann::json json;
  std::string binary;

  explicit ReadSubtree(const std::string& bytes) {
    EXPECT_EQ(bytes.substr(0, 4), "subt");
    std::uint64_t length = 0;
    std::memcpy(&length, bytes.data() + 8, 8);
    json = nlohmann::json::parse(bytes.substr(24, length));
    binary = bytes.substr(24 + length);
  }

  bool is_set(const char* what, std::size_t index) const {
    const auto& about = json[what];
    if (about.contains("constant")) return about["constant"] == 1;
    const std::size_t offset = json["bufferViews"][about["bitstream"].get<int>()]["byteOffset"];
    return (static_cast<unsigned char>(binary[offset + index / 8]) >> (index % 8) & 1) == 1;
  }

  std::vector<double> lowest() const {
    const auto& table = json["propertyTables"][0];
    const int view = table["properties"]["min_height"]["values"];
    std::vector<double> values(table["count"].get<std::size_t>());
    std::memcpy(values.data(),
                binary.data() + json["bufferViews"][view]["byteOffset"].get<std::size_t>(),
                values.size() * sizeof(double));
    return values;
  }
};

/// Three zooms: both roots, then tiles on both sides of the meridian of 180 degrees.
std::map<std::string, std::string> files_across_180() {
  const std::vector<GeodeticTiles> available = {
      {.zoom = 0, .x = 0, .y = 0, .columns = 2, .rows = 1},
      {.zoom = 1, .x = 3, .y = 0, .columns = 2, .rows = 1},
      {.zoom = 2, .x = 7, .y = 1, .columns = 2, .rows = 1}};
  std::map<std::string, std::string> files;
  for (const OutputFile& file : terrain_tileset(available, "", [](const TmsTile& tile) {
         return TerrainFacts{.min_height_m = 100.0 * tile.zoom + static_cast<double>(tile.x),
                             .max_height_m = 1000};
       })) {
    files.emplace(file.path, file.content);
  }
  return files;
}

TEST(TerrainTileset, HasTwoImplicitRootsWithARegionEach) {
  const auto json = nlohmann::json::parse(files_across_180().at("tileset.json"));
  const auto& roots = json["root"]["children"];
  ASSERT_EQ(roots.size(), 2U);
  EXPECT_NEAR(roots[0]["boundingVolume"]["region"][0].get<double>(), -M_PI, 1e-12);
  EXPECT_EQ(roots[0]["boundingVolume"]["region"][2], 0);
  EXPECT_EQ(roots[1]["boundingVolume"]["region"][0], 0);
  EXPECT_EQ(roots[1]["implicitTiling"]["availableLevels"], 3);
  std::set<std::string> semantics;
  for (const auto& [name, property] : json["schema"]["classes"]["tile"]["properties"].items()) {
    semantics.insert(property["semantic"].get<std::string>());
  }
  EXPECT_EQ(semantics,
            (std::set<std::string>{"TILE_MINIMUM_HEIGHT", "TILE_MAXIMUM_HEIGHT",
                                   "TILE_BOUNDING_SPHERE", "TILE_HORIZON_OCCLUSION_POINT"}));
}

TEST(TerrainTileset, SubtreesNameTheTilesOfTheirHalfOfTheEarth) {
  const auto files = files_across_180();
  const ReadSubtree east(files.at("subtrees/east/0/0/0.subtree"));
  // zoom 1: x 3 is the eastern column of the eastern root, the north is y 1
  EXPECT_TRUE(east.is_set("tileAvailability", 0));
  EXPECT_FALSE(east.is_set("tileAvailability", 1));
  EXPECT_TRUE(east.is_set("tileAvailability", 1 + 3));
  // zoom 2: x 7, the second row from the north: x 3, y 2 below the root, Morton code 1101
  EXPECT_TRUE(east.is_set("tileAvailability", 5 + 13));
  EXPECT_EQ(east.lowest(), (std::vector<double>{1, 103, 207}));
  const ReadSubtree west(files.at("subtrees/west/0/0/0.subtree"));
  EXPECT_EQ(west.lowest(), (std::vector<double>{0, 100, 200}));
  EXPECT_TRUE(west.is_set("tileAvailability", 1 + 2));  // x 0, y 1
  EXPECT_TRUE(west.is_set("tileAvailability", 5 + 8));  // x 0, y 2
  EXPECT_FALSE(west.is_set("childSubtreeAvailability", 0));
}

TEST(TerrainTileset, TilesAreBelowTheirRoot) {
  EXPECT_EQ(glb_path_of({0, 1, 0}), "east/0/0/0.glb");
  EXPECT_EQ(glb_path_of({3, 7, 2}), "west/3/7/2.glb");
  EXPECT_EQ(glb_path_of({3, 9, 2}), "east/3/1/2.glb");
}

}  // namespace
}  // namespace terrane::tiler

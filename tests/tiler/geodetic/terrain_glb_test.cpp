#include "tiler/geodetic/terrain_glb.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "tiler/geodetic/grid_lattice.h"

namespace terrane::tiler {
namespace {

constexpr double kStep_m = 1.0 / 128;
constexpr auto kEnd = static_cast<std::int32_t>(kTileSteps);

/// Four triangles around a summit, over 5 to 6 degrees east and 44 to 45 north or so.
TerrainTile pyramid() {
  TerrainTile tile{.tile = {8, 263, 190}, .height_step_m = 0.5};
  tile.vertices = {
      {0, 0, 10}, {kEnd, 0, 20}, {kEnd, kEnd, 30}, {0, kEnd, 40}, {16000, 16000, 4000}};
  tile.normals.assign(5, Eigen::Vector3f(0.6F, 0, 0.8F));
  tile.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  return tile;
}

struct Glb {
  nlohmann::json json;
  std::string binary;

  explicit Glb(const std::string& bytes) {
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, 4);
    json = nlohmann::json::parse(bytes.substr(20, length));
    binary = bytes.substr(20 + length + 8);
  }

  template <class T>
  std::vector<T> values(int accessor, std::size_t components) const {
    const auto& about = json["accessors"][accessor];
    const auto& view = json["bufferViews"][about["bufferView"].get<int>()];
    const std::size_t offset = view.value("byteOffset", std::size_t{0});  // 0 is left out
    std::vector<T> result(about["count"].get<std::size_t>() * components);
    std::memcpy(result.data(), binary.data() + offset, result.size() * sizeof(T));
    return result;
  }
};

TEST(TerrainGlb, PositionsAndTheNodesMatrixAreEarthCentredOnceYIsTurnedUp) {
  const TerrainTile tile = in_order_of_use(pyramid());
  const Glb glb(encode_terrain_glb(tile, kStep_m, "somebody"));
  EXPECT_EQ(glb.json["asset"]["copyright"], "somebody");
  const auto& primitive = glb.json["meshes"][0]["primitives"][0];
  const auto at = glb.values<float>(primitive["attributes"]["POSITION"], 3);
  const auto matrix = glb.json["nodes"][0]["matrix"].get<std::array<double, 16>>();
  const std::vector<Eigen::Vector3d> ecef = ecef_of(tile);
  ASSERT_EQ(at.size(), 15U);
  for (std::size_t v = 0; v < 5; ++v) {
    const Eigen::Vector3d turned(at[3 * v] + matrix[12], at[3 * v + 1] + matrix[13],
                                 at[3 * v + 2] + matrix[14]);
    // CesiumJS's Axis.Y_UP_TO_Z_UP: (x, y, z) to (x, -z, y)
    const Eigen::Vector3d place(turned.x(), -turned.z(), turned.y());
    EXPECT_LE((place - ecef[v]).cwiseAbs().maxCoeff(), kStep_m / 2);
    EXPECT_EQ(std::remainder(place.x(), kStep_m), 0);
    EXPECT_EQ(std::remainder(place.y(), kStep_m), 0);
    EXPECT_EQ(std::remainder(place.z(), kStep_m), 0);
  }
}

TEST(TerrainGlb, StepsAreTheFinestThatFloatsHoldAllOverATile) {
  for (const int zoom : {0, 5, 12, 22}) {
    const double step_m = place_step_m(zoom, 3000);
    // half the way round the equator, halved with each zoom
    const double reach_m = 20037508.34 / std::exp2(zoom) + 3000;
    EXPECT_LE(reach_m / step_m, std::exp2(24));
    EXPECT_GT(reach_m / step_m, std::exp2(23));
    EXPECT_EQ(std::exp2(std::round(std::log2(step_m))), step_m);
  }
}

TEST(TerrainGlb, ListsTheBordersClockwise) {
  const TerrainTile tile = in_order_of_use(pyramid());
  const Glb glb(encode_terrain_glb(tile, kStep_m, ""));
  const auto& edges = glb.json["meshes"][0]["primitives"][0]["extensions"]["CESIUM_tile_edges"];
  const auto height = [&](const char* side, std::size_t k) {
    return tile.vertices[glb.values<std::uint16_t>(edges[side], 1).at(k)].height;
  };
  EXPECT_EQ(height("left", 0), 10);  // from the south
  EXPECT_EQ(height("left", 1), 40);
  EXPECT_EQ(height("top", 0), 40);  // from the west
  EXPECT_EQ(height("top", 1), 30);
  EXPECT_EQ(height("right", 0), 30);  // from the north
  EXPECT_EQ(height("right", 1), 20);
  EXPECT_EQ(height("bottom", 0), 20);  // from the east
  EXPECT_EQ(height("bottom", 1), 10);
}

TEST(TerrainFacts, HaveTheHeightsOfTheVertices) {
  const TerrainFacts facts = facts_of(pyramid(), ecef_of(pyramid()));
  EXPECT_EQ(facts.min_height_m, 5);
  EXPECT_EQ(facts.max_height_m, 2000);
  for (const Eigen::Vector3d& at : ecef_of(pyramid())) {
    EXPECT_LE((at - facts.sphere.centre).norm(), facts.sphere.radius_m);
  }
}

}  // namespace
}  // namespace terrane::tiler

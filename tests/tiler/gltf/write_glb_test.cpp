#include "tiler/gltf/write_glb.h"

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "core/errors.h"

namespace terrane::tiler {
namespace {

/// A square of two triangles, ten steps wide, about (1000, 2000, 300).
TileMesh square() {
  TileMesh mesh;
  mesh.points = {{1000, 2000, 300}, {1000, 1990, 302}, {1010, 1990, 304}, {1010, 2000, 306}};
  mesh.samples.resize(4);
  mesh.normals.assign(4, Eigen::Vector3f::UnitZ());
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

GlbTile tile_of(const TileMesh& mesh, const TileId& id = {0, 0, 0},
                const Eigen::Vector3d& step_m = {1, 1, 1}) {
  return {
      .id = id, .mesh = mesh, .targets = mesh.points, .skirt = {}, .step_m = step_m, .texture = {}};
}

std::uint32_t word_at(const std::string& bytes, std::size_t at) {
  std::uint32_t word;
  std::memcpy(&word, bytes.data() + at, 4);
  return word;
}

nlohmann::json json_of(const std::string& glb) {
  return nlohmann::json::parse(glb.substr(20, word_at(glb, 12)));
}

TEST(EncodeGlb, HeaderStatesTheLengthsOfFileAndChunks) {
  const TileMesh mesh = square();
  const std::string glb = encode_glb(tile_of(mesh, {0, 3, 4}, {0.5, 0.5, 0.25}), {});
  EXPECT_EQ(glb.substr(0, 4), "glTF");
  EXPECT_EQ(word_at(glb, 4), 2U);
  EXPECT_EQ(word_at(glb, 8), glb.size());
  const std::uint32_t json_bytes = word_at(glb, 12);
  EXPECT_EQ(json_bytes % 4, 0U);
  EXPECT_EQ(20 + json_bytes + 8 + word_at(glb, 20 + json_bytes), glb.size());
}

TEST(EncodeGlb, NodePutsTheOriginWhereItLiesInTheWorldYUp) {
  const TileMesh mesh = square();
  const auto json = json_of(encode_glb(tile_of(mesh, {2, 3, 4}, {0.5, 0.5, 0.25}), {}));
  const auto extras = json["meshes"][0]["extras"]["terrane"];
  EXPECT_EQ(extras["level"], 2);
  EXPECT_EQ(extras["origin"], (std::vector<int>{1005, 1995, 303}));
  EXPECT_EQ(json["nodes"][0]["scale"], (std::vector<double>{0.5, 0.25, 0.5}));
  EXPECT_EQ(json["nodes"][0]["translation"], (std::vector<double>{502.5, 75.75, -997.5}));
}

TEST(EncodeGlb, MorphTargetAndAttributeAreOneAccessor) {
  const TileMesh mesh = square();
  const auto primitive = json_of(encode_glb(tile_of(mesh), {}))["meshes"][0]["primitives"][0];
  EXPECT_EQ(primitive["targets"][0]["POSITION"], primitive["attributes"]["_MORPH"]);
}

TEST(EncodeGlb, AccessorBoundsAreThoseOfThePositions) {
  const TileMesh mesh = square();
  const auto json = json_of(encode_glb(tile_of(mesh), {}));
  const auto position =
      json["accessors"]
          [json["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<std::size_t>()];
  EXPECT_EQ(position["min"], (std::vector<double>{-5, -3, -5}));
  EXPECT_EQ(position["max"], (std::vector<double>{5, 3, 5}));
}

TEST(EncodeGlb, PositionsBeyondSixteenBitsAreFloats) {
  constexpr int kShort = 5122, kFloat = 5126;
  TileMesh mesh = square();
  const auto type = [&](const char* name) {
    const auto json = json_of(encode_glb(tile_of(mesh), {}));
    const auto& attributes = json["meshes"][0]["primitives"][0]["attributes"];
    return json["accessors"][attributes[name].get<std::size_t>()]["componentType"];
  };
  EXPECT_EQ(type("POSITION"), kShort);
  mesh.points[2].i += 70000;
  EXPECT_EQ(type("POSITION"), kFloat);
  EXPECT_EQ(type("_MORPH"), kShort);
}

TEST(EncodeGlb, RefusesADisplacementThatTwentyFourBitsCannotHold) {
  const TileMesh mesh = square();
  std::vector<LatticePoint> targets = mesh.points;
  targets[2].i += 1 << 23;
  GlbTile tile = tile_of(mesh);
  tile.targets = targets;
  EXPECT_THROW(encode_glb(tile, {}), OutputError);
}

}  // namespace
}  // namespace terrane::tiler

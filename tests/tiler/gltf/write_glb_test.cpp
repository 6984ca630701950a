#include "tiler/gltf/write_glb.h"

#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "core/errors.h"

namespace terrane::tiler {
namespace {

/// A square of two triangles, ten steps wide, about (1000, 2000, 300).
TileMesh square() {
  TileMesh mesh;
  mesh.points = {{1000, 2000, 300}, {1000, 1990, 302}, {1010, 1990, 304}, {1010, 2000, 306}};
  mesh.borders.resize(4);
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

TEST(EncodeGlb, CodedStreamsBeginAsTheExtensionWants) {
  // appendix A of EXT_meshopt_compression
  constexpr unsigned char kAttributes = 0xa0, kTriangles = 0xe1;
  const TileMesh mesh = square();
  const std::string glb = encode_glb(tile_of(mesh), {});
  const auto json = json_of(glb);
  std::size_t triangles = 0;
  for (const auto& view : json["bufferViews"]) {
    const auto& coded = view["extensions"]["EXT_meshopt_compression"];
    const bool is_triangles = coded["mode"] == "TRIANGLES";
    triangles += is_triangles ? 1 : 0;
    const std::size_t at = 28 + word_at(glb, 12) + coded.value("byteOffset", std::size_t{0});
    EXPECT_EQ(static_cast<unsigned char>(glb[at]), is_triangles ? kTriangles : kAttributes);
  }
  EXPECT_EQ(triangles, 1U);
  EXPECT_EQ(json["bufferViews"].size(), 3U);
}

TEST(EncodeGlb, NormalsGoThroughTheOctahedralFilterAndComeOutWithinTwoSteps) {
  TileMesh mesh = square();
  const std::vector<Eigen::Vector3f> normals = {
      Eigen::Vector3f::UnitZ(), Eigen::Vector3f(0.48F, 0.6F, 0.64F),
      Eigen::Vector3f(-0.8F, 0.36F, 0.48F), Eigen::Vector3f(0.1F, -0.7F, std::sqrt(0.5F))};
  mesh.normals = normals;
  const std::string glb = encode_glb(tile_of(mesh), {});
  const auto json = json_of(glb);
  const auto& attributes = json["meshes"][0]["primitives"][0]["attributes"];
  const auto& accessor = json["accessors"][attributes["NORMAL"].get<std::size_t>()];
  const auto& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
  const auto& coded = view["extensions"]["EXT_meshopt_compression"];
  ASSERT_EQ(coded["filter"], "OCTAHEDRAL");
  std::vector<std::array<std::int8_t, 4>> decoded(4);
  const auto* from = reinterpret_cast<const unsigned char*>(glb.data()) + 28 + word_at(glb, 12) +
                     coded.value("byteOffset", std::size_t{0});
  ASSERT_EQ(meshopt_decodeVertexBuffer(decoded.data(), 4, 4, from,
                                       coded["byteLength"].get<std::size_t>()),
            0);
  meshopt_decodeFilterOct(decoded.data(), 4, 4);
  for (const Eigen::Vector3f& n : normals) {
    const Eigen::Vector3f y_up(n.x() * 127, n.z() * 127, -n.y() * 127);
    EXPECT_TRUE(std::ranges::any_of(decoded, [&](const auto& d) {
      return (Eigen::Vector3f(d[0], d[1], d[2]) - y_up).cwiseAbs().maxCoeff() <= 2;
    })) << n.transpose();
  }
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

/// The square with its second triangle in water.
TileMesh shore() {
  TileMesh mesh = square();
  mesh.normals.assign(4, Eigen::Vector3f(0.6F, 0, 0.8F));
  mesh.grounds.resize(4);
  mesh.in_water = {0, 1};
  return mesh;
}

TEST(EncodeGlb, WaterIsASecondPrimitiveOnTheSameVerticesWithAMaterialOfItsOwn) {
  const TileMesh mesh = shore();
  const auto json = json_of(encode_glb(tile_of(mesh), {.colour = Colour::kSlope}));
  const auto& primitives = json["meshes"][0]["primitives"];
  ASSERT_EQ(primitives.size(), 2U);
  for (const char* name : {"POSITION", "_MORPH"}) {
    EXPECT_EQ(primitives[0]["attributes"][name], primitives[1]["attributes"][name]);
  }
  EXPECT_EQ(primitives[0]["targets"], primitives[1]["targets"]);
  EXPECT_TRUE(primitives[0]["attributes"].contains("COLOR_0"));
  EXPECT_FALSE(primitives[1]["attributes"].contains("COLOR_0"));
  for (const auto& primitive : primitives) {
    EXPECT_EQ(json["accessors"][primitive["indices"].get<std::size_t>()]["count"], 3);
  }
  const auto& land = json["materials"][primitives[0]["material"].get<std::size_t>()];
  const auto& water = json["materials"][primitives[1]["material"].get<std::size_t>()];
  EXPECT_FALSE(land.contains("name"));
  EXPECT_EQ(water["name"], "water");
  EXPECT_LT(water["pbrMetallicRoughness"]["roughnessFactor"], 0.5);
}

TEST(EncodeGlb, UnlitWaterWithAPictureShowsThePicture) {
  const TileMesh mesh = shore();
  GlbTile tile = tile_of(mesh);
  tile.texture = {.bytes = "jpeg", .media_type = "image/jpeg", .columns_px = 2, .rows_px = 2};
  tile.texture.window = {0, 0, 2, 2};
  const auto json = json_of(encode_glb(tile, {.material = Material::kUnlit}));
  ASSERT_EQ(json["materials"].size(), 2U);
  for (const auto& material : json["materials"]) {
    EXPECT_EQ(material["pbrMetallicRoughness"]["baseColorTexture"]["index"], 0);
    EXPECT_FALSE(material["pbrMetallicRoughness"].contains("baseColorFactor"));
    EXPECT_TRUE(material["extensions"].contains("KHR_materials_unlit"));
  }
  EXPECT_TRUE(json["materials"][1]["pbrMetallicRoughness"].contains("roughnessFactor"));
  for (const auto& primitive : json["meshes"][0]["primitives"]) {
    EXPECT_TRUE(primitive["attributes"].contains("TEXCOORD_0"));
  }
}

TEST(EncodeGlb, WaterLooksUpEverywhereAlsoOnAShoreThatDoesNot) {
  const TileMesh mesh = shore();
  const std::string glb = encode_glb(tile_of(mesh), {.compression = Compression::kNone});
  const auto json = json_of(glb);
  const auto& water = json["meshes"][0]["primitives"][1]["attributes"];
  const auto& accessor = json["accessors"][water["NORMAL"].get<std::size_t>()];
  const auto& view = json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
  const auto* bytes = glb.data() + 28 + word_at(glb, 12) + view.value("byteOffset", std::size_t{0});
  for (std::size_t v = 0; v < 4; ++v, bytes += view["byteStride"].get<std::size_t>()) {
    EXPECT_EQ(bytes[0], 0);
    EXPECT_EQ(bytes[1], 127);
    EXPECT_EQ(bytes[2], 0);
  }
}

TEST(EncodeGlb, ATileAllInWaterHasWaterAlone) {
  TileMesh mesh = shore();
  mesh.in_water = {1, 1};
  for (const Compression compression :
       {Compression::kMeshopt, Compression::kDraco, Compression::kNone}) {
    const auto json = json_of(encode_glb(tile_of(mesh), {.compression = compression}));
    ASSERT_EQ(json["meshes"][0]["primitives"].size(), 1U);
    EXPECT_EQ(json["meshes"][0]["primitives"][0]["material"], 0);
    ASSERT_EQ(json["materials"].size(), 1U);
    EXPECT_EQ(json["materials"][0]["name"], "water");
  }
}

TEST(EncodeGlb, WithoutWaterTheMarksOfLandChangeNothing) {
  TileMesh mesh = shore();
  mesh.in_water = {0, 0};
  const std::string marked = encode_glb(tile_of(mesh), {});
  mesh.in_water = {};
  EXPECT_EQ(encode_glb(tile_of(mesh), {}), marked);
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

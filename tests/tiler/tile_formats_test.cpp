#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "tests/tiler/test_dem.h"
#include "tiler/build.h"
#include "tiler/verify/verify.h"

namespace terrane::tiler {
namespace {

using testing::content_of;
using testing::FunctionDem;
using testing::GeographicPlace;
using testing::TemporaryFolder;

double hills(std::int64_t column, std::int64_t row) {
  const auto x = static_cast<double>(column), y = static_cast<double>(row);
  return 800 + 60 * std::sin(0.11 * x) * std::cos(0.07 * y) + 9 * std::sin(0.9 * x + 0.4 * y);
}

const GeographicPlace kAlps({7.5, 46.5}, 1.0 / 1200);

/// Tiles of a hilly DEM with a hole, and what the verifier says of them.
class BuiltHills {
 public:
  explicit BuiltHills(const TileFormat& format, int tile_cells = 16) {
    NoProgress progress;
    options_ = {.tolerance_m = 2, .tile_cells = tile_cells, .format = format};
    build(dem_, kAlps, dem_.statistics(), options_, folder_.path(), progress);
  }

  std::filesystem::path path(const char* name) const { return folder_.path() / name; }
  nlohmann::json json(const char* name) const {
    return nlohmann::json::parse(content_of(path(name)));
  }

  verify::VerifyReport verdict() const {
    NoProgress progress;
    return verify::verify(folder_.path(), dem_, kAlps, {}, progress);
  }

  /// Builds again. \return whether nothing was left to do
  bool again() const {
    NoProgress progress;
    return build(dem_, kAlps, dem_.statistics(), options_, folder_.path(), progress).was_up_to_date;
  }

 private:
  FunctionDem dem_{{60, 45}, [](auto column, auto row) {
                     return column / 3 == 5 && row / 4 == 6 ? NAN : hills(column, row);
                   }};
  BuildOptions options_;
  TemporaryFolder folder_;
};

struct Named {
  const char* name;
  TileFormat format;
};

void PrintTo(const Named& named, std::ostream* stream) { *stream << named.name; }

class EveryFormat : public ::testing::TestWithParam<Named> {};

TEST_P(EveryFormat, HoldsEveryInvariantAndIsNotRepeated) {
  const BuiltHills built(GetParam().format);
  const auto report = built.verdict();
  EXPECT_TRUE(report.holds()) << to_text(report);
  EXPECT_TRUE(built.again());
}

INSTANTIATE_TEST_SUITE_P(
    All, EveryFormat,
    ::testing::Values(
        Named{"Plain", {.compression = Compression::kNone}},
        Named{"Draco", {.compression = Compression::kDraco, .colour = Colour::kSlope}},
        Named{"Float", {.positions = Positions::kMetres, .material = Material::kUnlit}},
        Named{"PlainFloat",
              {.compression = Compression::kNone, .positions = Positions::kMetres, .skirt_m = 30}},
        Named{"DracoFloat",
              {.compression = Compression::kDraco, .positions = Positions::kMetres, .skirt_m = 0}},
        Named{"Skirts", {.colour = Colour::kHypsometric, .skirt_m = 0, .attribution = "NASA"}},
        Named{"Split", {.tiles_per_tileset = 3}},
        Named{"Implicit", {.is_implicit = true, .skirt_m = 0}}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST(TileFormats, FloatsAreTheSamePlacesToTheBit) {
  // the verifier has them all back on the lattice, and compares them with neighbours and levels
  const BuiltHills whole({.compression = Compression::kNone}),
      floats({.compression = Compression::kNone, .positions = Positions::kMetres});
  tinygltf::TinyGLTF loader;
  tinygltf::Model a, b;
  std::string said;
  ASSERT_TRUE(loader.LoadBinaryFromFile(&a, &said, &said, whole.path("tiles/0/1/1.glb"))) << said;
  ASSERT_TRUE(loader.LoadBinaryFromFile(&b, &said, &said, floats.path("tiles/0/1/1.glb"))) << said;
  const auto bounds = [](const tinygltf::Model& model) {
    const auto& primitive = model.meshes[0].primitives[0];
    return model.accessors[primitive.attributes.at("POSITION")].maxValues;
  };
  ASSERT_EQ(b.extensionsRequired, std::vector<std::string>{});
  EXPECT_TRUE(b.nodes[0].scale.empty());
  EXPECT_EQ(a.nodes[0].translation, b.nodes[0].translation);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(bounds(a)[axis] * a.nodes[0].scale[axis], bounds(b)[axis]);
  }
}

TEST(TileFormats, TinygltfOpensEveryTileThatIsNotCompressed) {
  const BuiltHills built(
      {.compression = Compression::kNone, .colour = Colour::kSlope, .skirt_m = 0});
  int tiles = 0;
  for (const auto& file : std::filesystem::recursive_directory_iterator(built.path("tiles"))) {
    if (file.path().extension() != ".glb") continue;
    tinygltf::Model model;
    std::string said;
    EXPECT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &said, &said, file.path())) << said;
    EXPECT_EQ(said, "");
    EXPECT_EQ(model.meshes[0].primitives[0].attributes.count("COLOR_0"), 1U);
    ++tiles;
  }
  EXPECT_EQ(tiles, 12 + 4 + 1);
}

// 60 x 45 samples in tiles of 4 cells: 15 x 11 leaves, levels 0 to 4, so that level 3 is not two
// below the root; with tiles of 2 it is
TEST(TileFormats, AboveItsSizeATreeIsSplitIntoFilesOfAFewLevels) {
  const BuiltHills whole({.tiles_per_tileset = 100000}, 4);
  EXPECT_FALSE(std::filesystem::exists(whole.path("tilesets")));
  EXPECT_EQ(whole.json("terrane.json")["tilesets"]["files"], 1);
}

TEST(TileFormats, AnExternalTilesetBeginsWithTheTileThatRefersToIt) {
  const TemporaryFolder folder;
  const FunctionDem dem({200, 130}, hills);
  const BuildOptions options{
      .tolerance_m = 4, .tile_cells = 8, .format = {.tiles_per_tileset = 100}};
  NoProgress progress;
  build(dem, kAlps, dem.statistics(), options, folder.path(), progress);
  // 25 x 17 leaves: levels 0 to 5, split at level 3
  const auto read = [&](const char* name) {
    return nlohmann::json::parse(content_of(folder.path() / name))["root"];
  };
  const auto stub = read("tileset.json")["children"][0]["children"][3];
  EXPECT_EQ(stub["content"]["uri"], "tilesets/3/1/1.json");
  EXPECT_FALSE(stub.contains("children"));
  const auto root = read("tilesets/3/1/1.json");
  EXPECT_EQ(root["content"]["uri"], "../../../tiles/3/1/1.glb");
  EXPECT_EQ(root["boundingVolume"], stub["boundingVolume"]);
  EXPECT_EQ(root["children"].size(), 4U);
  const auto report = verify::verify(folder.path(), dem, kAlps, {}, progress);
  EXPECT_TRUE(report.holds()) << to_text(report);

  std::filesystem::remove(folder.path() / "tilesets/3/1/1.json");
  EXPECT_FALSE(
      build(dem, kAlps, dem.statistics(), options, folder.path(), progress).was_up_to_date);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "tilesets/3/1/1.json"));
}

TEST(TileFormats, ImplicitTilesHaveOneLevelInAnOctave) {
  BuildOptions options{.levels_per_octave = 2, .format = {.is_implicit = true}};
  EXPECT_THROW(check(options), ConfigError);
  options.levels_per_octave = 1;
  EXPECT_NO_THROW(check(options));
}

TEST(TileFormats, RefusesSettingsOutOfRange) {
  EXPECT_THROW(check(TileFormat{.tiles_per_tileset = 0}), ConfigError);
  EXPECT_THROW(check(TileFormat{.skirt_m = -1}), ConfigError);
  EXPECT_THROW(check(TileFormat{.texture_px = 8}), ConfigError);
}

TEST(TileFormats, AttributionIsWhereClientsLookForIt) {
  const BuiltHills built({.compression = Compression::kNone, .attribution = "NASA"});
  const auto asset = built.json("tileset.json")["asset"];
  EXPECT_EQ(asset["extras"]["cesium"]["credits"][0]["html"], "NASA");
  EXPECT_THAT(content_of(built.path("tiles/0/0/0.glb")),
              ::testing::HasSubstr("\"copyright\":\"NASA\""));
}

TEST(TileFormats, ASkirtThatIsNotBelowItsTileIsFound) {
  const BuiltHills built(
      {.compression = Compression::kNone, .positions = Positions::kMetres, .skirt_m = 30});
  const auto file = built.path("tiles/0/1/1.glb");
  std::string glb = content_of(file);
  tinygltf::Model model;
  std::string said;
  ASSERT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &said, &said, file)) << said;
  const auto& skirt = model.meshes[0].primitives[1];
  const auto& view = model.bufferViews[static_cast<std::size_t>(
      model.accessors[static_cast<std::size_t>(skirt.attributes.at("POSITION"))].bufferView)];
  std::uint32_t json_bytes = 0;
  std::memcpy(&json_bytes, glb.data() + 12, 4);
  // the height of its first vertex, from an exact number of metres to another
  const float moved = 1.0F;
  std::memcpy(glb.data() + 28 + json_bytes + view.byteOffset + 4, &moved, 4);
  std::ofstream(file, std::ios::binary) << glb;
  EXPECT_THAT(built.verdict().problems,
              ::testing::Contains(::testing::HasSubstr("tile 0/1/1: its skirt does not hang")));
}

}  // namespace
}  // namespace terrane::tiler

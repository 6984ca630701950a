// External tilesets and implicit tiling, made by hand from an explicit tileset.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "core/errors.h"
#include "tests/tiler/verify/fake_output.h"

namespace terrane::verify::testing {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;

json read_json(const std::filesystem::path& file) { return json::parse(std::ifstream(file)); }

void write(const std::filesystem::path& file, const std::string& content) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary | std::ios::trunc) << content;
}

/// 9 x 9 samples in four leaf tiles and a root.
struct Retold : ::testing::Test {
  FakeDem dem{{9, 9},
              [](auto column, auto row) { return static_cast<float>(2 * column + 4 * row); }};
  FlatPlace place;
  WrittenOutput written{halved_grids(dem, flat_world(place), 4, 1)};

  std::filesystem::path path(const char* name) const { return written.folder() / name; }

  VerifyReport verdict() const {
    NoProgress progress;
    return verify(written.folder(), dem, place, {}, progress);
  }

  std::string error() const {
    try {
      verdict();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

// --- external tilesets

struct External : Retold {
  json tileset = read_json(path("tileset.json"));
  json& stub = tileset["root"]["children"][1];
  json below = {{"asset", {{"version", "1.1"}}}, {"root", stub}};

  External() {
    below["root"]["content"]["uri"] = "../../../tiles/0/1/0.glb";
    stub["content"]["uri"] = "tilesets/0/1/0.json";
  }

  void write_both() const {
    write(path("tileset.json"), tileset.dump());
    write(path("tilesets/0/1/0.json"), below.dump());
  }
};

TEST_F(External, TilesetHolds) {
  write_both();
  EXPECT_TRUE(verdict().holds()) << to_text(verdict());
}

TEST_F(External, TilesetThatIsMissingIsNamed) {
  write(path("tileset.json"), tileset.dump());
  EXPECT_THAT(error(), HasSubstr("tilesets/0/1/0.json: missing"));
}

TEST_F(External, TilesetWithAnotherBoxThanItsTileIsFound) {
  stub["boundingVolume"]["box"][3] = 1e6;
  write_both();
  EXPECT_THAT(verdict().problems,
              Contains("tile 0/1/0: its box, error or extras are not those of its tileset's root"));
}

TEST_F(External, TilesetWithATransformIsFound) {
  below["root"]["transform"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1};
  write_both();
  EXPECT_THAT(verdict().problems, Contains(HasSubstr("has a transform of its own")));
}

TEST_F(External, TilesetOutsideTheFolderIsRefused) {
  stub["content"]["uri"] = "../../elsewhere.json";
  write_both();
  EXPECT_THAT(error(), HasSubstr("'../../elsewhere.json' is no tileset of this output"));
}

TEST_F(External, TilesetThatRefersToItselfIsRefused) {
  below["root"]["content"]["uri"] = "0.json";
  write_both();
  EXPECT_THAT(error(), HasSubstr("is no tileset of this output"));
}

TEST_F(External, TilesetThatNobodyRefersToIsFound) {
  write(path("tilesets/0/0/0.json"), below.dump());
  EXPECT_THAT(verdict().problems, Contains("tilesets/0/0/0.json: not in tileset.json"));
}

// --- implicit tiling

/// The same tiles as one subtree of two levels: the root, and its children in the order of Morton,
/// (0, 0), (1, 0), (0, 1), (1, 1), as the explicit tileset has them.
struct Implicit : Retold {
  json subtree;
  std::string binary;

  Implicit() {
    json tileset = read_json(path("tileset.json"));
    const json root = tileset["root"];
    std::vector<json> tiles = {root};
    for (const json& child : root["children"]) tiles.push_back(child);
    json& retold = tileset["root"];
    retold.erase("children");
    retold["content"]["uri"] = "content/{level}/{x}/{y}.glb";
    retold["implicitTiling"] = {{"subdivisionScheme", "QUADTREE"},
                                {"availableLevels", 2},
                                {"subtreeLevels", 2},
                                {"subtrees", {{"uri", "subtrees/{level}/{x}/{y}.subtree"}}}};
    tileset["schema"]["classes"]["tile"]["properties"]["box"] = {{"semantic", "TILE_BOUNDING_BOX"}};
    write(path("tileset.json"), tileset.dump());
    for (const json& tile : tiles) move_content(tile["extras"]["terrane"]);
    std::filesystem::remove_all(path("tiles"));
    describe(tiles);
  }

  void move_content(const json& extras) const {
    const int level = extras["level"], x = extras["x"], y = extras["y"];
    const auto to = written.folder() / fmt::format("content/{}/{}/{}.glb", 1 - level, x, y);
    std::filesystem::create_directories(to.parent_path());
    std::filesystem::rename(written.folder() / fmt::format("tiles/{}/{}/{}.glb", level, x, y), to);
  }

  template <class T>
  std::size_t add_view(const std::vector<T>& values) {
    subtree["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", values.size() * sizeof(T)}});
    const std::size_t begin = binary.size();
    binary.resize((begin + values.size() * sizeof(T) + 7) / 8 * 8);
    std::memcpy(binary.data() + begin, values.data(), values.size() * sizeof(T));
    return subtree["bufferViews"].size() - 1;
  }

  void describe(const std::vector<json>& tiles) {
    std::vector<double> boxes, errors;
    std::vector<std::uint32_t> triangles, bytes;
    for (const json& tile : tiles) {
      for (const double number : tile["boundingVolume"]["box"]) boxes.push_back(number);
      errors.push_back(tile["extras"]["terrane"]["max_error_m"]);
      triangles.push_back(tile["extras"]["terrane"]["triangles"]);
      bytes.push_back(tile["extras"]["terrane"]["bytes"]);
    }
    json table = {{"class", "tile"}, {"count", tiles.size()}};
    table["properties"]["box"]["values"] = add_view(boxes);
    table["properties"]["max_error_m"]["values"] = add_view(errors);
    table["properties"]["triangles"]["values"] = add_view(triangles);
    table["properties"]["bytes"]["values"] = add_view(bytes);
    subtree["propertyTables"].push_back(table);
    subtree["tileMetadata"] = 0;
    subtree["tileAvailability"]["bitstream"] = add_view(std::vector<unsigned char>{0b11111});
    subtree["contentAvailability"].push_back({{"constant", 1}});
    subtree["childSubtreeAvailability"]["constant"] = 0;
  }

  void write_subtree() const {
    std::string text = subtree.dump();
    text.resize((text.size() + 7) / 8 * 8, ' ');
    std::string bytes("subt\1\0\0\0", 8);
    for (const std::uint64_t size : {text.size(), binary.size()}) {
      bytes.append(reinterpret_cast<const char*>(&size), 8);
    }
    write(path("subtrees/0/0/0.subtree"), bytes + text + binary);
  }
};

TEST_F(Implicit, TilesHold) {
  write_subtree();
  EXPECT_TRUE(verdict().holds()) << to_text(verdict());
}

TEST_F(Implicit, ASubtreeThatIsMissingIsNamed) {
  EXPECT_THAT(error(), HasSubstr("subtrees/0/0/0.subtree: missing"));
}

TEST_F(Implicit, ATileThatIsNotAvailableIsMissed) {
  subtree["tileAvailability"] = {{"constant", 0}};
  subtree["propertyTables"][0]["count"] = 0;
  write_subtree();
  EXPECT_THAT(verdict().problems, Contains("tile 1/0/0: missing from tileset.json"));
}

TEST_F(Implicit, ATileWithoutContentIsFound) {
  subtree["contentAvailability"][0] = {{"constant", 0}};
  write_subtree();
  EXPECT_THAT(verdict().problems, Contains("tile 0/1/1: is there, but has no content"));
}

TEST_F(Implicit, ABoxThatDoesNotHoldItsTileIsFound) {
  const double narrow = 1;
  std::memcpy(binary.data() + (2 * 12 + 3) * sizeof narrow, &narrow, sizeof narrow);
  write_subtree();
  EXPECT_THAT(verdict().problems, Contains(HasSubstr("tile 0/1/0: its box lacks")));
}

TEST_F(Implicit, ASubtreeCutOffAnywhereIsNamed) {
  write_subtree();
  std::ifstream stream(path("subtrees/0/0/0.subtree"), std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(stream), {}};
  for (std::size_t size = 0; size < whole.size(); size += 41) {
    write(path("subtrees/0/0/0.subtree"), whole.substr(0, size));
    ASSERT_THAT(error(), HasSubstr("subtrees/0/0/0.subtree: damaged")) << size;
  }
}

TEST_F(Implicit, ASubtreeWithAnyByteChangedIsReadNamedOrFoundWanting) {
  write_subtree();
  std::ifstream stream(path("subtrees/0/0/0.subtree"), std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(stream), {}};
  for (std::size_t at = 0; at < whole.size(); at += 5) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 0x15);
    write(path("subtrees/0/0/0.subtree"), changed);
    error();  // must not crash
  }
}

}  // namespace
}  // namespace terrane::verify::testing

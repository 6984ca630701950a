#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "core/errors.h"
#include "tests/tiler/verify/fake_output.h"

namespace terrane::verify::testing {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

struct WrittenSlope : ::testing::Test {
  FakeDem dem{{9, 9},
              [](auto column, auto row) { return static_cast<float>(2 * column + 4 * row); }};
  FlatPlace place;
  FakeOutput output = halved_grids(dem, flat_world(place), 4, 1);

  VerifyReport verdict() const { return verdict_on(output, dem, place); }

  /// What verify says of a folder; empty if it throws nothing.
  std::string error_of(const std::filesystem::path& folder) const {
    NoProgress progress;
    try {
      verify(folder, dem, place, {}, progress);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

std::string content_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void replace_content(const std::filesystem::path& file, const std::string& content) {
  std::ofstream(file, std::ios::binary | std::ios::trunc) << content;
}

TEST_F(WrittenSlope, HoldsAsItIs) { EXPECT_TRUE(verdict().holds()) << to_text(verdict()); }

// --- what cannot be read at all

TEST_F(WrittenSlope, AFolderWithoutTerraneJsonIsNoFinishedOutput) {
  const WrittenOutput written(output);
  std::filesystem::remove(written.folder() / "terrane.json");
  EXPECT_THAT(error_of(written.folder()),
              AllOf(HasSubstr(written.folder().string()),
                    HasSubstr("not a finished terrane output"), HasSubstr("terrane build")));
}

TEST_F(WrittenSlope, AMissingTilesetIsNamed) {
  const WrittenOutput written(output);
  std::filesystem::remove(written.folder() / "tileset.json");
  EXPECT_THAT(error_of(written.folder()), HasSubstr("tileset.json: missing"));
}

TEST_F(WrittenSlope, AMissingTileFileIsNamed) {
  const WrittenOutput written(output);
  std::filesystem::remove(written.folder() / "tiles/0/1/0.glb");
  EXPECT_THAT(error_of(written.folder()), HasSubstr("tiles/0/1/0.glb: tileset.json lists it"));
}

TEST_F(WrittenSlope, ATileCutOffAnywhereIsNamed) {
  const WrittenOutput written(output);
  const auto file = written.folder() / "tiles/0/0/1.glb";
  const std::string whole = content_of(file);
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    replace_content(file, whole.substr(0, size));
    ASSERT_THAT(error_of(written.folder()), HasSubstr("tiles/0/0/1.glb: damaged")) << size;
  }
}

TEST_F(WrittenSlope, ATileWithAnyByteChangedIsReadNamedOrFoundWanting) {
  const WrittenOutput written(output);
  const auto file = written.folder() / "tiles/0/0/1.glb";
  const std::string whole = content_of(file);
  for (std::size_t at = 0; at < whole.size(); at += 3) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 0x15);
    replace_content(file, changed);
    const std::string error = error_of(written.folder());  // must not crash
    if (error.empty()) continue;
    ASSERT_THAT(error, HasSubstr("tiles/0/0/1.glb")) << at;
  }
}

TEST_F(WrittenSlope, JsonCutOffAnywhereIsNamed) {
  for (const char* name : {"terrane.json", "tileset.json"}) {
    const WrittenOutput written(output);
    const std::string whole = content_of(written.folder() / name);
    for (std::size_t size = 0; size < whole.size(); size += 97) {
      replace_content(written.folder() / name, whole.substr(0, size));
      ASSERT_THAT(error_of(written.folder()), HasSubstr(std::string(name) + ": damaged"));
    }
  }
}

TEST_F(WrittenSlope, AnotherFormatIsRefused) {
  output.edit_terrane = [](auto& terrane) { terrane["format"] = "terrane/9"; };
  EXPECT_THAT(error_of(WrittenOutput(output).folder()), HasSubstr("terrane.json: format"));
}

TEST_F(WrittenSlope, StepsThatAreNoPowersOfTwoAreRefused) {
  output.edit_terrane = [](auto& terrane) { terrane["levels"][1]["step_m"][2] = 0.75; };
  EXPECT_THAT(error_of(WrittenOutput(output).folder()), HasSubstr("step_m[2] of level 1 is 0.75"));
}

TEST_F(WrittenSlope, ADemOfAnotherShapeIsRefused) {
  const FakeDem other({9, 10}, [](auto, auto) { return 0.0F; });
  const WrittenOutput written(output);
  NoProgress progress;
  EXPECT_THAT([&] { verify(written.folder(), other, place, {}, progress); },
              ::testing::ThrowsMessage<InputError>(
                  AllOf(HasSubstr("9 x 9"), HasSubstr("9 x 10"), HasSubstr("--dem"))));
}

// --- what can be read and is wrong

TEST_F(WrittenSlope, ATileLeftOutOfTheTilesetIsMissingAndItsFileIsStray) {
  output.edit_tile = [](auto& entry, const FakeTile& tile) {
    if (tile.level == 1) entry["children"].erase(3);  // 0/1/1
  };
  const VerifyReport report = verdict();
  EXPECT_EQ(report.levels[0].tiles_missing, 1);
  EXPECT_EQ(report.levels[0].tiles_unexpected, 1);
  EXPECT_EQ(report.levels[0].uncovered_samples, 4 * 4);  // the others cover its west and north
  EXPECT_EQ(report.levels[0].mismatched_same_level, 2 * 5);
  EXPECT_THAT(report.problems, Contains("tile 0/1/1: missing from tileset.json"));
  EXPECT_THAT(report.problems, Contains("tiles/0/1/1.glb: not in tileset.json"));
}

TEST_F(WrittenSlope, AParentThatStatesLessThanItsChildBreaksTheNesting) {
  output.tile(0, 0, 1).max_error_m = 2.5;  // the root states 2
  const VerifyReport report = verdict();
  EXPECT_EQ(report.levels[1].nested_errors_violated, 1);
  EXPECT_THAT(report.problems, Contains(AllOf(HasSubstr("tile 1/0/0"), HasSubstr("tile 0/0/1"))));
}

TEST_F(WrittenSlope, AnErrorStatedTooSmallIsFound) {
  FakeTile& tile = output.tile(0, 1, 0);
  tile.position[tile.vertex_at(6, 2)][2] += 3;  // 0.75 m
  tile.morph[tile.vertex_at(6, 2)][2] -= 3;
  tile.max_error_m = 0.7499;
  const VerifyReport report = verdict();
  EXPECT_EQ(report.levels[0].samples_over_tolerance, 0);
  EXPECT_EQ(report.levels[0].stated_error_too_small, 1);
  tile.max_error_m = 0.75;
  EXPECT_TRUE(verdict().holds());
}

TEST_F(WrittenSlope, ABoxThatLacksAVertexIsFound) {
  output.edit_tile = [](auto& entry, const FakeTile& tile) {
    if (tile.level != 0 || tile.x != 1 || tile.y != 1) return;
    entry["boundingVolume"]["box"][3] = 15.9;  // of 16 m
  };
  const VerifyReport report = verdict();
  EXPECT_EQ(report.levels[0].boxes_violated, 1);
  EXPECT_THAT(report.problems, Contains(HasSubstr("tile 0/1/1: its box lacks")));
}

TEST_F(WrittenSlope, ABoxThatContainsTheTileOnlyAtRestIsFound) {
  FakeTile& tile = output.tile(0, 0, 0);
  tile.morph[tile.vertex_at(1, 1)][2] += 2 * 1000;  // 500 m up
  output.highest_m = 400;
  EXPECT_EQ(verdict().levels[0].boxes_violated, 1);
}

TEST_F(WrittenSlope, ABoxThatSticksOutOfItsParentsIsFound) {
  output.edit_tile = [](auto& entry, const FakeTile& tile) {
    if (tile.level == 0 && tile.x == 0) entry["boundingVolume"]["box"][11] = 1000.1;
  };
  const VerifyReport report = verdict();
  EXPECT_EQ(report.levels[1].boxes_violated, 2);
  EXPECT_EQ(report.levels[0].boxes_violated, 0);
}

/// One statement that is not so, and the words that the problem must hold.
struct Misstatement {
  const char* name;
  std::function<void(FakeOutput&)> make;
  const char* words;
};

class MisstatedSlope : public WrittenSlope, public ::testing::WithParamInterface<Misstatement> {};

TEST_P(MisstatedSlope, IsFoundAndNamed) {
  GetParam().make(output);
  const VerifyReport report = verdict();
  EXPECT_FALSE(report.holds());
  EXPECT_EQ(report.levels[0].facts_misstated + report.levels[1].facts_misstated, 1);
  EXPECT_THAT(report.problems, Contains(HasSubstr(GetParam().words)));
}

std::function<void(FakeOutput&)> in_glb(std::function<void(nlohmann::json&)> edit) {
  return [edit](FakeOutput& output) { output.edit_glb = edit; };
}

std::function<void(FakeOutput&)> in_entry(std::function<void(nlohmann::json&)> edit) {
  return [edit](FakeOutput& output) {
    output.edit_tile = [edit](nlohmann::json& entry, const FakeTile& tile) {
      if (tile.level == 0 && tile.x == 0 && tile.y == 0) edit(entry);
    };
  };
}

std::function<void(FakeOutput&)> in_terrane(std::function<void(nlohmann::json&)> edit) {
  return [edit](FakeOutput& output) { output.edit_terrane = edit; };
}

const Misstatement kMisstatements[] = {
    Misstatement{"Scale", in_glb([](auto& glb) { glb["nodes"][0]["scale"][1] = 0.5; }),
                 "tile 0/0/0: the node's scale"},
    Misstatement{"Translation", in_glb([](auto& glb) { glb["nodes"][0]["translation"][2] = 0.25; }),
                 "tile 0/0/0: the node's translation"},
    Misstatement{"Min", in_glb([](auto& glb) { glb["accessors"][0]["min"][0] = 1; }),
                 "tile 0/0/0: min and max"},
    Misstatement{"MorphTarget", in_glb([](auto& glb) {
                   glb["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = 0;
                 }),
                 "tile 0/0/0: its morph target"},
    Misstatement{"Name", in_glb([](auto& glb) { glb["meshes"][0]["extras"]["terrane"]["x"] = 1; }),
                 "tile 0/0/0: its glb says that it is tile 0/1/0"},
    Misstatement{"Triangles", in_entry([](auto& e) { e["extras"]["terrane"]["triangles"] = 31; }),
                 "tile 0/0/0: 31 triangles stated, 32 found"},
    Misstatement{"Bytes", in_entry([](auto& e) { e["extras"]["terrane"]["bytes"] = 1; }),
                 "tile 0/0/0: 1 bytes stated"},
    Misstatement{"GeometricError", in_entry([](auto& e) { e["geometricError"] = 2; }),
                 "tile 0/0/0: geometricError"},
    Misstatement{"Uri", in_entry([](auto& e) { e["content"]["uri"] = "tiles/0/1/0.glb"; }),
                 "tile 0/0/0: its content is"},
    Misstatement{"LevelTiles", in_terrane([](auto& terrane) { terrane["levels"][0]["tiles"] = 5; }),
                 "terrane.json: level 0 states 5 tiles"},
    Misstatement{"LevelTriangles",
                 in_terrane([](auto& terrane) { terrane["levels"][1]["triangles"] = 33; }),
                 "terrane.json: level 1 states 33 triangles"},
    Misstatement{"LargestDiagonal", in_terrane([](auto& terrane) {
                   terrane["levels"][1]["largest_diagonal_m"] = 100;
                 }),
                 "tile 1/0/0: its box has a diagonal"},
    Misstatement{"Transform", [](FakeOutput& output) { output.root_transform.assign(16, 0.0); },
                 "a local frame has no transform"}};

INSTANTIATE_TEST_SUITE_P(All, MisstatedSlope, ::testing::ValuesIn(kMisstatements),
                         [](const auto& each) { return std::string(each.param.name); });

// --- what is said of it

TEST_F(WrittenSlope, TextEndsWithTheVerdict) {
  EXPECT_THAT(to_text(verdict()), ::testing::EndsWith("All invariants hold.\n"));
  output.tile(1, 0, 0).morph[0] = {0, 0, 1};
  EXPECT_THAT(to_text(verdict()), ::testing::EndsWith("NOT all invariants hold.\n"));
}

TEST_F(WrittenSlope, JsonHoldsEveryLevel) {
  const auto json = nlohmann::json::parse(to_json(verdict()));
  EXPECT_EQ(json["holds"], true);
  ASSERT_EQ(json["levels"].size(), 2U);
  EXPECT_EQ(json["levels"][0]["triangles"], 2 * 8 * 8);
  EXPECT_EQ(json["levels"][0]["morph"].size(), kMorphTimes.size());
  EXPECT_EQ(json["levels"][0]["morph"][6]["t"], 0.5);
  EXPECT_TRUE(json["levels"][1]["morph"].empty());
}

}  // namespace
}  // namespace terrane::verify::testing

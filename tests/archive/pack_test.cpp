#include "archive/pack.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "archive/packed_folder.h"
#include "archive/pmtiles_header.h"
#include "archive/write_three_tz.h"
#include "core/deflate/deflate.h"
#include "core/errors.h"
#include "tests/temporary_folder.h"

namespace terrane::archive {
namespace {

namespace fs = std::filesystem;
using terrane::testing::TemporaryFolder;
using ::testing::HasSubstr;

class Pack : public ::testing::TestWithParam<const char*> {
 protected:
  /// A folder of three levels as terrane build writes it: level 0 is the finest.
  void write_terrane_folder() const {
    folder_.write("out/tileset.json",
                  R"({"asset":{"version":"1.1"},"root":{"geometricError":0.1}})");
    folder_.write("out/terrane.json", R"({"format":"terrane/1"})");
    folder_.write("out/build.toml", "[build]\ntolerance_m = 1.0\n");
    folder_.write("out/tilesets/1/0/0.json",
                  R"({"asset":{"version":"1.1"},"a":"aaaaaaaaaaaaaaaa"})");
    folder_.write("out/index.html", "viewer");
    folder_.write("out/.hidden/state", "hidden");
    folder_.write("out/tileset.json.gz", "sibling");
    for (int level = 0; level <= 2; ++level) {
      const int side = 4 >> level;
      for (int x = 0; x < side; ++x) {
        for (int y = 0; y < side; ++y) {
          folder_.write(fs::path("out/tiles") / std::to_string(level) / std::to_string(x) /
                            (std::to_string(y) + ".glb"),
                        "glTF" + std::to_string(level * 100 + x * 10 + y));
        }
      }
    }
  }

  fs::path file() const { return folder_ / (std::string("x.") + GetParam()); }
  bool is_pmtiles() const { return GetParam() == std::string("pmtiles"); }

  void pack_folder() const { pack(folder_ / "out", file(), {"index.html"}, quiet_); }

  static std::map<std::string, std::string> contents_of(const Archive& archive) {
    std::map<std::string, std::string> contents;
    archive.for_each_name([&](const std::string& name) {
      EXPECT_TRUE(contents.emplace(name, archive.read(name).value()).second) << name;
    });
    return contents;
  }

  TemporaryFolder folder_;
  mutable NoProgress quiet_;
};

TEST_P(Pack, HoldsTheFilesOfTheFolderAndNothingElse) {
  write_terrane_folder();
  pack_folder();
  const auto contents = contents_of(*open_archive(file()));
  EXPECT_EQ(contents.size(), 4u + 21u);
  EXPECT_EQ(contents.at("tileset.json"), folder_.read("out/tileset.json"));
  EXPECT_EQ(contents.at("build.toml"), folder_.read("out/build.toml"));
  EXPECT_EQ(contents.at("tilesets/1/0/0.json"), folder_.read("out/tilesets/1/0/0.json"));
  EXPECT_EQ(contents.at("tiles/0/3/2.glb"), "glTF32");
  EXPECT_EQ(contents.at("tiles/2/0/0.glb"), "glTF200");
  EXPECT_FALSE(open_archive(file())->read("index.html"));
  EXPECT_FALSE(open_archive(file())->read("tiles/0/4/0.glb"));
  EXPECT_FALSE(open_archive(file())->read("../secret"));
}

TEST_P(Pack, UnpacksToTheSameFiles) {
  write_terrane_folder();
  pack_folder();
  unpack(*open_archive(file()), folder_ / "again", quiet_);
  EXPECT_EQ(folder_.read("again/tiles/1/1/0.glb"), "glTF110");
  EXPECT_EQ(folder_.read("again/terrane.json"), folder_.read("out/terrane.json"));
  EXPECT_THROW(unpack(*open_archive(file()), folder_ / "again", quiet_), OutputError);
}

TEST_P(Pack, GivesTheSameBytesAgain) {
  write_terrane_folder();
  pack_folder();
  const std::string first = folder_.read(file().filename());
  folder_.write("out/terrane.json", folder_.read("out/terrane.json"));  // another time stamp
  pack_folder();
  EXPECT_TRUE(folder_.read(file().filename()) == first);
}

TEST_P(Pack, RefusesAFolderWithoutTilesAndLeavesNothingBehind) {
  folder_.write("out/thesis.tex", "It was a dark and stormy night");
  EXPECT_THROW(pack_folder(), InputError);
  EXPECT_FALSE(fs::exists(file()));
  EXPECT_THROW(pack(folder_ / "none", file(), {}, quiet_), InputError);
}

TEST_P(Pack, RefusesAnUnfinishedBuild) {
  write_terrane_folder();
  folder_.write("out/.work/key", "k");
  try {
    pack_folder();
    FAIL() << "packed half a build";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("not finished"));
  }
}

TEST_P(Pack, NamesTheFileThatCannotBeWritten) {
  write_terrane_folder();
  try {
    pack(folder_ / "out", std::string("/proc/none/x.") + GetParam(), {}, quiet_);
    FAIL() << "wrote to /proc";
  } catch (const OutputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/proc/none/x."));
  }
}

INSTANTIATE_TEST_SUITE_P(BothFormats, Pack, ::testing::Values("pmtiles", "3tz"),
                         [](const auto& format) { return std::string("As_") + format.param; });

class PackPmtiles : public ::testing::Test {
 protected:
  PmtilesHeader packed() const {
    NoProgress quiet;
    pack(folder_ / "out", folder_ / "x.pmtiles", {}, quiet);
    return read_header(ArchiveFile(folder_ / "x.pmtiles"));
  }

  TemporaryFolder folder_;
};

TEST_F(PackPmtiles, StoresEqualTilesOnceAndRunsOfThemAsOneEntry) {
  folder_.write("out/tiles.json", R"({"bounds":[-10,-20,30,40]})");
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 8; ++y) {
      folder_.write(fs::path("out/3") / std::to_string(x) / (std::to_string(y) + ".png"),
                    x == 7 && y == 0 ? "land" : "sea");
    }
  }
  folder_.write("out/0/0/0.png", "all");
  const PmtilesHeader header = packed();
  EXPECT_EQ(header.addressed_tiles, 65u);
  EXPECT_EQ(header.tile_contents, 3u);
  EXPECT_EQ(header.tile_entries, 3u);  // (7, 0) is where the curve ends: all, 63 of sea, land
  EXPECT_EQ(header.tiles.length, 10u);
  EXPECT_EQ(header.tile_type, 2);
  EXPECT_EQ(header.min_zoom, 0);
  EXPECT_EQ(header.max_zoom, 3);
  EXPECT_EQ(header.west_e7, -100'000'000);
  EXPECT_EQ(header.north_e7, 400'000'000);
  EXPECT_EQ(open_archive(folder_ / "x.pmtiles")->read("3/5/5.png"), "sea");
  EXPECT_EQ(open_archive(folder_ / "x.pmtiles")->read("3/7/0.png"), "land");
}

TEST_F(PackPmtiles, SaysWhereTilesAreGzippedAndKeepsThemSo) {
  folder_.write("out/layer.json", "{}");
  const std::string tile = gzip("quantized mesh");
  for (const char* name : {"0/0/0.terrain", "0/1/0.terrain", "1/3/1.terrain"}) {
    folder_.write(fs::path("out") / name, tile);
  }
  const PmtilesHeader header = packed();
  EXPECT_EQ(header.tile_compression, PmtilesHeader::kGzip);
  EXPECT_EQ(header.min_zoom, 1);  // two roots: a zoom deeper
  EXPECT_EQ(header.max_zoom, 2);
  EXPECT_EQ(open_archive(folder_ / "x.pmtiles")->read("0/1/0.terrain"), tile);
}

TEST_F(PackPmtiles, DividesLargeDirectoriesSoThatTheRootFitsIntoTheFirstRequest) {
  folder_.write("out/tiles.json", "{}");
  std::uint32_t noise = 1;
  for (int x = 0; x < 128; ++x) {
    for (int y = 0; y < 128; ++y) {
      noise = noise * 1664525 + 1013904223;
      folder_.write(fs::path("out/7") / std::to_string(x) / (std::to_string(y) + ".png"),
                    std::string(1 + (noise >> 20) % 200, 'x') + std::to_string(x * 128 + y));
    }
  }
  const PmtilesHeader header = packed();
  EXPECT_GT(header.leaves.length, 0u);
  EXPECT_LE(header.root.offset + header.root.length, PmtilesHeader::kFirstRequestBytes);
  const auto archive = open_archive(folder_ / "x.pmtiles");
  EXPECT_EQ(archive->facts().files, 16384u + 1u);
  for (int x = 0; x < 128; x += 9) {
    const std::string name = "7/" + std::to_string(x) + "/77.png";
    EXPECT_EQ(archive->read(name), folder_.read("out/" + name));
  }
}

TEST_F(PackPmtiles, RefusesTilesThatAreNoQuadtree) {
  folder_.write("out/tiles.json", "{}");
  folder_.write("out/0/9/0.png", "x");
  folder_.write("out/1/9/9.png", "x");
  EXPECT_THROW(packed(), InputError);
}

// A plain ZIP holds 65,535 files at most.
TEST(WriteThreeTz, HoldsMoreFilesThanAPlainZip) {
  const TemporaryFolder folder;
  folder.write("tile", "glTF");
  std::vector<PackedFile> files;
  for (int i = 0; i < 66'000; ++i) {
    files.push_back({"tiles/" + std::to_string(100'000 + i) + ".glb", folder / "tile", 4});
  }
  NoProgress quiet;
  write_three_tz(files, folder / "x.3tz", quiet);
  const auto archive = open_archive(folder / "x.3tz");
  EXPECT_EQ(archive->facts().files, files.size());
  EXPECT_EQ(archive->read("tiles/165999.glb"), "glTF");
  EXPECT_FALSE(archive->read("tiles/166000.glb"));
}

TEST(OpenArchive, RefusesWhatIsNoArchive) {
  const TemporaryFolder folder;
  folder.write("x.pmtiles", "GIF89a");
  EXPECT_THROW(open_archive(folder / "x.pmtiles"), InputError);
  EXPECT_THROW(open_archive(folder / "none.pmtiles"), InputError);
  EXPECT_THROW(open_archive(folder / "."), InputError);
}

TEST(OpenArchive, SaysThatAPmtilesOfOthersIsNotOurs) {
  const TemporaryFolder folder;
  const std::string metadata = gzip(R"({"name":"basemap"})");
  PmtilesHeader header;
  header.metadata = {PmtilesHeader::kBytes, metadata.size()};
  folder.write("x.pmtiles", encode_header(header) + metadata);
  try {
    open_archive(folder / "x.pmtiles");
    FAIL() << "opened";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("terrane pack"));
  }
}

TEST(IsSafeName, RefusesEveryWayOut) {
  for (const char* name : {"", "/etc/passwd", "../x", "a/../x", "a//b", "a/", ".hidden", "a/.git/x",
                           "a\\b", "a\nb", "./a"}) {
    EXPECT_FALSE(is_safe_name(name)) << name;
  }
  EXPECT_TRUE(is_safe_name("tiles/0/1/2.glb"));
}

}  // namespace
}  // namespace terrane::archive

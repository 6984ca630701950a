// Archives that are cut off or changed: an InputError or good data, and never a read out of bounds
// (these tests run with the address sanitizer).
#include <gtest/gtest.h>

#include <random>

#include "archive/archive.h"
#include "archive/little_endian.h"
#include "archive/pack.h"
#include "archive/pmtiles_header.h"
#include "core/deflate/deflate.h"
#include "core/errors.h"
#include "tests/temporary_folder.h"

namespace terrane::archive {
namespace {

class DamagedArchive : public ::testing::TestWithParam<const char*> {
 protected:
  DamagedArchive() {
    folder_.write("out/tileset.json", R"({"asset":{"version":"1.1"}})");
    folder_.write("out/sub/a.json", std::string(300, ' ') + "{}");
    for (int x = 0; x < 2; ++x) {
      for (int y = 0; y < 2; ++y) {
        folder_.write("out/tiles/0/" + std::to_string(x) + "/" + std::to_string(y) + ".glb",
                      "glTF" + std::to_string(x + 2 * y));
      }
    }
    folder_.write("out/tiles/1/0/0.glb", "glTF root");
    NoProgress quiet;
    const std::string extension = GetParam() == std::string("3tz") ? ".3tz" : ".pmtiles";
    pack(folder_ / "out", folder_ / ("x" + extension), {}, quiet);
    good_ = folder_.read("x" + extension);
    if (GetParam() == std::string("plain_pmtiles")) good_ = with_plain_directories(good_);
  }

  /// The same archive with directory and metadata uncompressed: no checksum of gzip's shields them.
  static std::string with_plain_directories(const std::string& packed) {
    terrane::testing::TemporaryFolder folder;
    folder.write("x", packed);
    PmtilesHeader header = read_header(ArchiveFile(folder / "x"));
    const auto plain = [&](const PmtilesHeader::Section& section) {
      return gunzip(packed.substr(section.offset, section.length), 1 << 20).value();
    };
    const std::string root = plain(header.root);
    const std::string metadata = plain(header.metadata);
    const std::string tiles = packed.substr(header.tiles.offset);
    header.internal_compression = PmtilesHeader::kNone;
    header.root = {PmtilesHeader::kBytes, root.size()};
    header.metadata = {header.root.offset + root.size(), metadata.size()};
    header.leaves = {header.metadata.offset + metadata.size(), 0};
    header.tiles = {header.leaves.offset, tiles.size()};
    return encode_header(header) + root + metadata + tiles;
  }

  /// Reads all of it; \return true if it opened.
  bool read_all_of(const std::string& bytes) const {
    // a new file each time: replacing the content of one makes the disk wait
    std::filesystem::remove(folder_ / "damaged");
    folder_.write("damaged", bytes);
    try {
      const auto archive = open_archive(folder_ / "damaged");
      int files = 0;
      archive->for_each_name([&](const std::string& name) {
        EXPECT_TRUE(is_safe_name(name));
        if (++files > 1000) throw InputError("more files than any test has");
        try {
          archive->read(name);
        } catch (const InputError&) {
        }
      });
      return true;
    } catch (const InputError&) {
      return false;
    }
  }

  terrane::testing::TemporaryFolder folder_;
  std::string good_;
};

TEST_P(DamagedArchive, IsGoodAsItIs) { EXPECT_TRUE(read_all_of(good_)); }

TEST_P(DamagedArchive, IsRefusedWhereItIsCutOff) {
  for (std::size_t length = 0; length < good_.size(); ++length) {
    EXPECT_FALSE(read_all_of(good_.substr(0, length))) << length;
  }
}

TEST_P(DamagedArchive, SurvivesEveryByteThatIsChanged) {
  for (std::size_t at = 0; at < good_.size(); ++at) {
    for (const int change : {0x01, 0x80, 0xff}) {
      std::string damaged = good_;
      damaged[at] = static_cast<char>(damaged[at] ^ change);
      read_all_of(damaged);
    }
  }
}

TEST_P(DamagedArchive, SurvivesNoise) {
  std::mt19937 random(7);
  for (int round = 0; round < 1500; ++round) {
    std::string damaged = good_;
    const int changes = 1 + static_cast<int>(random() % 8);
    for (int i = 0; i < changes; ++i)
      damaged[random() % damaged.size()] = static_cast<char>(random());
    read_all_of(damaged);
  }
}

TEST_P(DamagedArchive, SurvivesWildNumbers) {
  for (std::size_t at = 0; at + 8 <= std::min<std::size_t>(good_.size(), 400); ++at) {
    for (const std::uint64_t wild : {~std::uint64_t{0}, std::uint64_t{1} << 63, std::uint64_t{0}}) {
      std::string bytes;
      append_little_endian(bytes, wild);
      for (const bool from_end : {false, true}) {
        std::string damaged = good_;
        damaged.replace(from_end ? good_.size() - 8 - at : at, 8, bytes);
        read_all_of(damaged);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllFormats, DamagedArchive,
                         ::testing::Values("pmtiles", "plain_pmtiles", "3tz"),
                         [](const auto& format) { return std::string("As_") + format.param; });

}  // namespace
}  // namespace terrane::archive

#include "archive/pmtiles_directory.h"

#include <gtest/gtest.h>

#include <random>

#include "core/errors.h"
#include "tests/temporary_folder.h"

namespace terrane::archive {
namespace {

class Directory : public ::testing::Test {
 protected:
  Directory() { folder_.write("x.pmtiles", "x"); }

  std::vector<DirectoryEntry> decode(const std::string& bytes) const {
    return decode_directory(bytes, ArchiveFile(folder_ / "x.pmtiles"));
  }

  terrane::testing::TemporaryFolder folder_;
};

// Chapter 4.2 of the specification, by hand: two entries, ids 5 and 5 + 300, run lengths 1 and 2,
// lengths 100 and 7, offsets 0 (so 1) and "follows" (0). 300 = 0b10'0101100.
TEST_F(Directory, IsWrittenAsTheSpecificationSays) {
  const std::vector<DirectoryEntry> entries = {{5, 0, 100, 1}, {305, 100, 7, 2}};
  EXPECT_EQ(encode_directory(entries), std::string("\x02\x05\xac\x02\x01\x02\x64\x07\x01\x00", 10));
}

TEST_F(Directory, ComesBackAsItWas) {
  const std::vector<DirectoryEntry> entries = {
      {0, 77, 0xffffffff, 1}, {1, 0, 5, 3}, {4, std::uint64_t{1} << 40, 9, 0}, {1000, 5, 1, 1}};
  EXPECT_EQ(decode(encode_directory(entries)), entries);
}

TEST_F(Directory, RefusesWhatNoWriterWrites) {
  for (const std::string& bytes :
       {std::string(), std::string("\0", 1), std::string("\x01", 1),
        std::string("\xff\xff\xff\xff\x0f", 5),                  // billions of entries
        std::string("\x01\x05\x01\x00\x01", 5),                  // an empty tile
        std::string("\x01\x05\x01\x01\x00", 5),                  // first offset "follows"
        std::string("\x01\x05\x01\x01\x01\x01", 6),              // a byte left over
        std::string("\x02\x05\x00\x01\x01\x01\x01\x01\x01", 9),  // the same id twice
        std::string("\x02\x05\x01\x02\x01\x01\x01\x01\x01", 9),  // a run over the next
        std::string("\x01\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\x01\x01\x01", 14)}) {
    EXPECT_THROW(decode(bytes), InputError) << ::testing::PrintToString(bytes);
  }
}

TEST_F(Directory, SurvivesNoise) {
  std::mt19937 random(1);
  std::string bytes(40, '\0');
  for (int i = 0; i < 20'000; ++i) {
    for (char& byte : bytes) byte = static_cast<char>(random() >> ((random() & 1) ? 8 : 29));
    bytes[0] = static_cast<char>(random() % 12);
    try {
      for (const DirectoryEntry& entry : decode(bytes)) ASSERT_GT(entry.length, 0u);
    } catch (const InputError&) {
    }
  }
}

}  // namespace
}  // namespace terrane::archive

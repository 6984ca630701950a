#include "tiler/files/whole_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.h"
#include "tests/tiler/test_dem.h"

namespace terrane::tiler {
namespace {

using testing::bytes_below;
using testing::TemporaryFolder;

TEST(WholeFile, WritesWhatItIsGivenAndNothingElse) {
  const TemporaryFolder folder;
  const std::string content("a\0b\n", 4);
  write_whole_file(folder.path() / "deep" / "down" / "file", content);
  EXPECT_EQ(bytes_below(folder.path()),
            (std::map<std::string, std::string>{{"deep/down/file", content}}));
  EXPECT_EQ(read_whole_file(folder.path() / "deep/down/file"), content);
}

TEST(WholeFile, AFailedWriteNamesTheFileAndLeavesNothing) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "taken");
  write_whole_file(folder.path() / "taken" / "keep", "x");
  try {
    write_whole_file(folder.path() / "taken", "content");
    FAIL() << "a folder was overwritten";
  } catch (const OutputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("taken"));
  }
  EXPECT_EQ(bytes_below(folder.path()).size(), 1U);
}

}  // namespace
}  // namespace terrane::tiler

#include "tiler/files/output_folder.h"

#include <gtest/gtest.h>

#include "core/errors.h"
#include "tests/tiler/test_dem.h"
#include "tiler/files/whole_file.h"

namespace terrane::tiler {
namespace {

using testing::TemporaryFolder;

TEST(OutputFolder, RefusesAFolderWithFilesOfOthersUnlessForced) {
  const TemporaryFolder folder;
  write_whole_file(folder.path() / "thesis.txt", "precious");
  EXPECT_THROW(OutputFolder(folder.path()).claim(false), OutputError);
  EXPECT_NO_THROW(OutputFolder(folder.path()).claim(true));
}

TEST(OutputFolder, RefusesAFile) {
  const TemporaryFolder folder;
  write_whole_file(folder.path() / "file", "x");
  EXPECT_THROW(OutputFolder(folder.path() / "file").claim(true), OutputError);
}

TEST(OutputFolder, MakesWhatIsMissingAndTakesItsOwnAgain) {
  const TemporaryFolder folder;
  const OutputFolder out(folder.path() / "new" / "one");
  out.claim(false);
  out.begin("key");
  EXPECT_NO_THROW(out.claim(false));
}

TEST(OutputFolder, TakesAFolderAgainThatARunLeftBeforeItWroteItsKey) {
  const TemporaryFolder folder;
  const OutputFolder out(folder.path());
  std::filesystem::create_directories(folder.path() / ".work");
  EXPECT_NO_THROW(out.claim(false));
  write_whole_file(folder.path() / ".work/key.tmp", "ke");
  EXPECT_NO_THROW(out.claim(false));
}

TEST(OutputFolder, RefusesAWorkFolderOfOthers) {
  const TemporaryFolder folder;
  write_whole_file(folder.path() / ".work/thesis.txt", "precious");
  EXPECT_THROW(OutputFolder(folder.path()).claim(false), OutputError);
}

TEST(OutputFolder, BeginKeepsWorkOfTheSameKeyAndDropsThatOfAnother) {
  const TemporaryFolder folder;
  const OutputFolder out(folder.path());
  out.begin("one");
  write_whole_file(out.finished_tile({0, 1, 2}), "work");
  out.begin("one");
  EXPECT_TRUE(std::filesystem::exists(out.finished_tile({0, 1, 2})));
  out.begin("two");
  EXPECT_FALSE(std::filesystem::exists(out.finished_tile({0, 1, 2})));
}

TEST(OutputFolder, BeginRemovesWhatAnyOtherFormatLeft) {
  const TemporaryFolder folder;
  for (const char* name : {"layer.json", "tiles.json", "7/3/2.terrain", "west/0/0/0.glb"}) {
    write_whole_file(folder.path() / name, "old");
  }
  OutputFolder(folder.path()).begin("key");
  for (const char* name : {"layer.json", "tiles.json", "7", "west"}) {
    EXPECT_FALSE(std::filesystem::exists(folder.path() / name)) << name;
  }
}

TEST(OutputFolder, BeginLeavesFilesOfOthersAlone) {
  const TemporaryFolder folder;
  write_whole_file(folder.path() / "thesis.txt", "precious");
  OutputFolder(folder.path()).begin("key");
  EXPECT_EQ(read_whole_file(folder.path() / "thesis.txt"), "precious");
}

TEST(OutputFolder, AnEmptyFolderHoldsNothingFinished) {
  const TemporaryFolder folder;
  EXPECT_EQ(OutputFolder(folder.path()).finished_key(), "");
}

}  // namespace
}  // namespace terrane::tiler

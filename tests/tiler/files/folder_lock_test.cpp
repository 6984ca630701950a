#include "tiler/files/folder_lock.h"

#include <gtest/gtest.h>

#include <optional>

#include "core/errors.h"
#include "tests/tiler/test_dem.h"

namespace terrane::tiler {
namespace {

TEST(FolderLock, KeepsOthersOutAsLongAsItLives) {
  const testing::TemporaryFolder folder;
  std::optional<FolderLock> first(folder.path());
  EXPECT_THROW(FolderLock{folder.path()}, OutputError);
  first.reset();
  EXPECT_NO_THROW(FolderLock{folder.path()});
}

TEST(FolderLock, LeavesNothingBehind) {
  const testing::TemporaryFolder folder;
  { const FolderLock lock(folder.path()); }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace terrane::tiler

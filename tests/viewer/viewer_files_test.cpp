#include "viewer/server/viewer_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <string>

#include "core/errors.h"
#include "tests/temporary_folder.h"

namespace terrane::viewer {
namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

class WriteViewer : public ::testing::Test {
 protected:
  void SetUp() override {
    if (viewer_files().empty()) GTEST_SKIP() << "built without the viewer (TERRANE_WEB=OFF)";
  }
  terrane::testing::TemporaryFolder out_;
};

TEST_F(WriteViewer, WritesTheFrontPageAndWhatItLoads) {
  write_viewer(out_.path() / "new");
  const std::string page = content_of(out_.path() / "new/index.html");
  EXPECT_THAT(page, ::testing::HasSubstr("assets/viewer.js"));
  EXPECT_GT(fs::file_size(out_.path() / "new/assets/viewer.js"), 10'000u);
  for (const ViewerFile& file : viewer_files()) {
    EXPECT_EQ(content_of(out_.path() / "new" / file.path), file.content) << file.path;
  }
}

TEST_F(WriteViewer, WritesThePageOfVolumesLikewise) {
  write_volume_page(out_.path());
  const std::string page = content_of(out_.path() / "index.html");
  EXPECT_THAT(page, ::testing::HasSubstr("assets/volume.js"));
  for (const ViewerFile& file : volume_page_files()) {
    EXPECT_EQ(content_of(out_.path() / file.path), file.content) << file.path;
  }
}

TEST_F(WriteViewer, LeavesNothingElseBehind) {
  write_viewer(out_.path());
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(out_.path())) {
    files += entry.is_regular_file();
  }
  EXPECT_EQ(files, viewer_files().size());
}

TEST_F(WriteViewer, ReplacesOldFilesAndLeavesEqualOnesAlone) {
  write_viewer(out_.path());
  const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(1);
  fs::last_write_time(out_.path() / "index.html", long_ago);
  out_.write("assets/viewer.js", "an older viewer");
  write_viewer(out_.path());
  EXPECT_EQ(fs::last_write_time(out_.path() / "index.html"), long_ago);
  EXPECT_GT(fs::file_size(out_.path() / "assets/viewer.js"), 10'000u);
}

TEST_F(WriteViewer, NamesTheFileItCannotWrite) {
  out_.write("assets", "a file where a folder must be");
  try {
    write_viewer(out_.path());
    FAIL() << "no error";
  } catch (const OutputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr((out_.path() / "assets").string()));
  }
}

}  // namespace
}  // namespace terrane::viewer

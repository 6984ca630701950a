#include "viewer/server/served_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <string>

#include "tests/temporary_folder.h"

namespace terrane::viewer {
namespace {

namespace fs = std::filesystem;

// secret.txt lies beside the served folder, as an attacker's prize.
class OpenServedFile : public ::testing::Test {
 protected:
  OpenServedFile() {
    outside_.write("secret.txt", "secret");
    outside_.write("served-too/secret.txt", "secret");
    outside_.write("served/index.html", "front page");
    outside_.write("served/tiles/0/1/2.glb", "tile");
    outside_.write("served/tiles/index.html", "tiles page");
    outside_.write("served/.work/state", "hidden");
    outside_.write("served/tiles/.hidden.glb", "hidden");
  }

  std::string read(std::string_view url_path) const {
    const auto file = open_served_file(outside_.path() / "served", url_path);
    return file ? file->content->read(0, file->content->bytes()) : "(none)";
  }

  fs::path served() const { return outside_.path() / "served"; }

  terrane::testing::TemporaryFolder outside_;
};

TEST_F(OpenServedFile, OpensFilesAndIndexPages) {
  EXPECT_EQ(read("/tiles/0/1/2.glb"), "tile");
  EXPECT_EQ(read("/index.html"), "front page");
  EXPECT_EQ(read("/"), "front page");
  EXPECT_EQ(read("/tiles/"), "tiles page");
}

TEST_F(OpenServedFile, RefusesWhatIsNoFile) {
  for (const char* path : {"", "index.html", "/none", "/tiles", "/tiles/0/", "/index.html/"}) {
    EXPECT_EQ(read(path), "(none)") << path;
  }
}

TEST_F(OpenServedFile, RefusesEveryWayOut) {
  const std::string absolute = (outside_.path() / "secret.txt").string();
  for (const std::string& path :
       {std::string("/../secret.txt"), std::string("/tiles/../../secret.txt"),
        std::string("/tiles/0/../../../secret.txt"), std::string("/./../secret.txt"),
        std::string("/..\\secret.txt"), std::string("/tiles\\..\\..\\secret.txt"),
        std::string("/../served-too/secret.txt"), absolute, "/" + absolute, "//" + absolute,
        std::string("/%2e%2e/secret.txt"), std::string("/index.html\0.glb", 16)}) {
    EXPECT_EQ(read(path), "(none)") << path;
  }
}

TEST_F(OpenServedFile, RefusesDotsEvenWhereTheyWouldStayInside) {
  for (const char* path : {"/tiles/../index.html", "/./index.html", "/../served/index.html"}) {
    EXPECT_EQ(read(path), "(none)") << path;
  }
}

TEST_F(OpenServedFile, RefusesHiddenFilesAndFolders) {
  for (const char* path : {"/.work/state", "/tiles/.hidden.glb", "/tiles/../.work/state"}) {
    EXPECT_EQ(read(path), "(none)") << path;
  }
}

TEST_F(OpenServedFile, FollowsLinksThatStayInsideOnly) {
  fs::create_symlink("index.html", served() / "inside.html");
  fs::create_symlink("../secret.txt", served() / "out.txt");
  fs::create_symlink(outside_.path() / "secret.txt", served() / "out_absolute.txt");
  fs::create_directory_symlink("..", served() / "up");
  fs::create_directory_symlink("../served-too", served() / "too");
  fs::create_directory_symlink(".work", served() / "unhidden");
  fs::create_symlink("loop", served() / "loop");
  EXPECT_EQ(read("/inside.html"), "front page");
  for (const char* path : {"/out.txt", "/out_absolute.txt", "/up/secret.txt", "/too/secret.txt",
                           "/unhidden/state", "/loop"}) {
    EXPECT_EQ(read(path), "(none)") << path;
  }
  EXPECT_EQ(read("/up/served/index.html"), "front page") << "leads out, and back in";
}

TEST_F(OpenServedFile, DoesNotWaitForANamedPipe) {
  ASSERT_EQ(::mkfifo((served() / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(read("/pipe"), "(none)");
}

TEST_F(OpenServedFile, KeepsWhatItOpenedWhenTheFileIsReplaced) {
  const auto file = open_served_file(served(), "/index.html");
  ASSERT_TRUE(file);
  outside_.write("served/new.html", "a new page");
  fs::rename(served() / "new.html", served() / "index.html");
  EXPECT_EQ(file->content->read(0, 100), "front page");
  EXPECT_EQ(file->content->read(6, 2), "pa");
  EXPECT_EQ(read("/index.html"), "a new page");
}

}  // namespace
}  // namespace terrane::viewer

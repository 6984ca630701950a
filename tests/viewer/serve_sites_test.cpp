// Archives, several data sets, and files that lie compressed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "archive/pack.h"
#include "core/deflate/deflate.h"
#include "core/errors.h"
#include "tests/temporary_folder.h"
#include "tests/viewer/gunzip.h"
#include "tests/viewer/raw_http.h"
#include "tests/viewer/running_server.h"
#include "viewer/server/viewer_files.h"

namespace terrane::viewer {
namespace {

namespace fs = std::filesystem;
using terrane::testing::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::RawAnswer;
using testing::request_raw;
using testing::RunningServer;

const std::string kGzip = "Accept-Encoding: gzip\r\n";
const std::string kBoth = "Accept-Encoding: gzip, br\r\n";

void write_tile_set(const TemporaryFolder& folder, const std::string& name) {
  folder.write(name + "/tileset.json", R"({"asset": {"version": "1.1"}})");
  folder.write(name + "/sub/0/0.json", std::string(2000, ' ') + "{}");
  folder.write(name + "/tiles/0/0/0.glb", "glTF of " + name);
}

class ServeArchive : public ::testing::TestWithParam<const char*> {
 protected:
  ServeArchive() {
    write_tile_set(folder_, "lake");
    NoProgress quiet;
    archive::pack(folder_.path() / "lake", folder_.path() / name(), {}, quiet);
  }
  static std::string name() { return std::string("lake.") + GetParam(); }

  TemporaryFolder folder_;
};

TEST_P(ServeArchive, SendsItsFilesAsIfTheyLayInAFolder) {
  const RunningServer server({.data = {folder_.path() / name()}});
  RawAnswer tile = request_raw(server.port(), "GET", "/tiles/0/0/0.glb");
  EXPECT_EQ(tile.body, "glTF of lake");
  EXPECT_EQ(tile.headers["content-type"], "model/gltf-binary");
  EXPECT_EQ(request_raw(server.port(), "GET", "/tiles/0/0/0.glb", "Range: bytes=-4\r\n").body,
            "lake");
  EXPECT_THAT(request_raw(server.port(), "GET", "/tileset.json").body, HasSubstr("\"1.1\""));
  EXPECT_EQ(request_raw(server.port(), "GET", "/tiles/0/1/0.glb").status, 404);
  const std::string tag = tile.headers["etag"];
  EXPECT_EQ(request_raw(server.port(), "GET", "/tiles/0/0/0.glb", "If-None-Match: " + tag + "\r\n")
                .status,
            304);
}

TEST_P(ServeArchive, SendsWhatItHoldsGzippedToEverybody) {
  const RunningServer server({.data = {folder_.path() / name()}});
  const std::string text = std::string(2000, ' ') + "{}";
  EXPECT_EQ(request_raw(server.port(), "GET", "/sub/0/0.json").body, text);
  RawAnswer gzipped = request_raw(server.port(), "GET", "/sub/0/0.json", kGzip);
  EXPECT_EQ(gzipped.headers["content-encoding"], "gzip");
  EXPECT_EQ(testing::gunzip(gzipped.body, text.size()), text);
}

TEST_P(ServeArchive, SendsTheArchiveItselfByRanges) {
  const RunningServer server({.data = {folder_.path() / name()}});
  RawAnswer answer =
      request_raw(server.port(), "GET", "/" + name(), "Range: bytes=0-1\r\n" + kGzip);
  EXPECT_EQ(answer.status, 206);
  EXPECT_EQ(answer.body, GetParam() == std::string("3tz") ? "PK" : "PM");
  EXPECT_EQ(answer.headers.count("content-encoding"), 0u);
}

INSTANTIATE_TEST_SUITE_P(BothFormats, ServeArchive, ::testing::Values("pmtiles", "3tz"),
                         [](const auto& format) { return std::string("As_") + format.param; });

TEST(ServeSeveral, ListsThemAndServesEachBelowItsName) {
  const TemporaryFolder folder;
  write_tile_set(folder, "lake");
  write_tile_set(folder, "b/<peak> 1");
  write_tile_set(folder, "c/lake");
  folder.write("lake/index.html", "viewer of lake");
  const RunningServer server(
      {.data = {folder.path() / "lake", folder.path() / "b/<peak> 1", folder.path() / "c/lake/"}});
  const std::string page = request_raw(server.port(), "GET", "/").body;
  EXPECT_THAT(page, HasSubstr("href=\"/lake/\""));
  EXPECT_THAT(page, HasSubstr("<b>lake-2</b>"));
  EXPECT_THAT(page, HasSubstr("&lt;peak&gt; 1"));
  EXPECT_THAT(page, HasSubstr("href=\"/%3Cpeak%3E%201/tileset.json\""));
  EXPECT_THAT(page, Not(HasSubstr("<peak>")));
  EXPECT_EQ(request_raw(server.port(), "GET", "/lake/tiles/0/0/0.glb").body, "glTF of lake");
  EXPECT_EQ(request_raw(server.port(), "GET", "/%3Cpeak%3E%201/tiles/0/0/0.glb").body,
            "glTF of b/<peak> 1");
  EXPECT_EQ(request_raw(server.port(), "GET", "/lake-2/tiles/0/0/0.glb").body, "glTF of c/lake");
  EXPECT_EQ(request_raw(server.port(), "GET", "/lake/").body, "viewer of lake");
  EXPECT_EQ(request_raw(server.port(), "GET", "/tiles/0/0/0.glb").status, 404);
  EXPECT_EQ(server.server().data_urls().size(), 3u);
}

TEST(ServeTree, IsOneFileWithTheViewerAroundIt) {
  const TemporaryFolder folder;
  folder.write("trees/a bunny.tree", "TERRTREE");
  folder.write("trees/secret.txt", "secret");
  const RunningServer server({.data = {folder.path() / "trees/a bunny.tree"}});
  EXPECT_THAT(server.server().data_urls().front(), ::testing::EndsWith("/?tree=a%20bunny.tree"));
  const auto tree = request_raw(server.port(), "GET", "/a%20bunny.tree");
  EXPECT_EQ(tree.body, "TERRTREE");
  EXPECT_EQ(request_raw(server.port(), "GET", "/secret.txt").status, 404);
  for (const auto& files : {viewer_files(), tree_page_files(), engine_files()}) {
    for (const ViewerFile& file : files) {
      EXPECT_EQ(request_raw(server.port(), "GET", "/" + std::string(file.path)).status, 200);
    }
  }
}

TEST(ServeTree, AFolderOfTreesHasTheViewerToo) {
  if (viewer_files().empty()) GTEST_SKIP() << "built without the viewer (TERRANE_WEB=OFF)";
  const TemporaryFolder folder;
  folder.write("trees/bunny.tree", "TERRTREE");
  folder.write("plain/readme.txt", "nothing to see");
  const RunningServer trees({.data = {folder.path() / "trees"}});
  EXPECT_EQ(request_raw(trees.port(), "GET", "/assets/tree_page.js").status, 200);
  const RunningServer plain({.data = {folder.path() / "plain"}});
  EXPECT_EQ(request_raw(plain.port(), "GET", "/assets/tree_page.js").status, 404);
}

TEST(ServeSeveral, LeadsToTheFolderWhereTheSlashIsMissing) {
  const TemporaryFolder folder;
  write_tile_set(folder, "a");
  write_tile_set(folder, "b");
  const RunningServer server({.data = {folder.path() / "a", folder.path() / "b"}});
  RawAnswer answer = request_raw(server.port(), "GET", "/b?x=1");
  EXPECT_EQ(answer.status, 301);
  EXPECT_EQ(answer.headers["location"], "/b/");
}

TEST(ServeSeveral, NeverLeadsFromOneToAnother) {
  const TemporaryFolder folder;
  write_tile_set(folder, "a");
  write_tile_set(folder, "b");
  folder.write("secret.txt", "secret");
  const RunningServer server({.data = {folder.path() / "a", folder.path() / "b"}});
  for (const char* target : {"/a/../b/tileset.json", "/a/../secret.txt", "/a/..%2fsecret.txt",
                             "/a%2f..%2fsecret.txt", "/../secret.txt", "/a/\\..\\..\\secret.txt",
                             "/a/%2e%2e/secret.txt", "/a//secret.txt", "/a/%00/../secret.txt"}) {
    const RawAnswer answer = request_raw(server.port(), "GET", target);
    EXPECT_TRUE(answer.status == 404 || answer.status == 400) << target;
    EXPECT_THAT(answer.body, Not(HasSubstr("secret"))) << target;
  }
}

TEST(ServeSeveral, RefusesToServeNothing) { EXPECT_THROW(Server(ServeOptions{}), ConfigError); }

class ServeCoded : public ::testing::Test {
 protected:
  ServeCoded() {
    folder_.write("layer.json", "plain layer");
    folder_.write("layer.json.br", "brotli layer");
    folder_.write("layer.json.gz", "gzip layer");
    folder_.write("0/0/0.terrain", gzip("mesh"));
    folder_.write("1/0/0.terrain", "plain mesh");
  }
  RawAnswer get(const std::string& target, const std::string& headers = "") const {
    return request_raw(server_.port(), "GET", target, headers);
  }

  TemporaryFolder folder_;
  RunningServer server_{{.data = {folder_.path()}}};
};

TEST_F(ServeCoded, PrefersWhatLiesCompressedBesideTheFile) {
  RawAnswer brotli = get("/layer.json", kBoth);
  EXPECT_EQ(brotli.body, "brotli layer");
  EXPECT_EQ(brotli.headers["content-encoding"], "br");
  EXPECT_EQ(brotli.headers["vary"], "Accept-Encoding");
  EXPECT_EQ(brotli.headers["content-type"], "application/json");
  RawAnswer gzipped = get("/layer.json", kGzip);
  EXPECT_EQ(gzipped.body, "gzip layer");
  EXPECT_EQ(gzipped.headers["content-encoding"], "gzip");
  RawAnswer plain = get("/layer.json");
  EXPECT_EQ(plain.body, "plain layer");
  EXPECT_EQ(plain.headers["vary"], "Accept-Encoding");
  EXPECT_NE(plain.headers["etag"], gzipped.headers["etag"]);
  EXPECT_NE(brotli.headers["etag"], gzipped.headers["etag"]);
}

TEST_F(ServeCoded, PassesOverACompressedFileThatIsOlder) {
  fs::last_write_time(folder_.path() / "layer.json.br",
                      fs::file_time_type::clock::now() - std::chrono::hours(1));
  EXPECT_EQ(get("/layer.json", kBoth).body, "gzip layer");
}

TEST_F(ServeCoded, NeverTakesACompressedFileForARange) {
  RawAnswer part = get("/layer.json", kBoth + "Range: bytes=0-4\r\n");
  EXPECT_EQ(part.status, 206);
  EXPECT_EQ(part.body, "plain");
}

// Cesium asks for `Accept-Encoding: gzip` and decodes by Content-Encoding alone.
TEST_F(ServeCoded, SaysThatATileIsGzippedAsItLies) {
  RawAnswer tile = get("/0/0/0.terrain", kGzip);
  EXPECT_EQ(tile.headers["content-encoding"], "gzip");
  EXPECT_EQ(testing::gunzip(tile.body, 4), "mesh");
  RawAnswer plain = get("/1/0/0.terrain", kGzip);
  EXPECT_EQ(plain.headers.count("content-encoding"), 0u);
  EXPECT_EQ(plain.body, "plain mesh");
}

TEST_F(ServeCoded, UnpacksATileForThoseWhoCannot) {
  RawAnswer tile = get("/0/0/0.terrain");
  EXPECT_EQ(tile.body, "mesh");
  EXPECT_EQ(tile.headers.count("content-encoding"), 0u);
  EXPECT_EQ(get("/0/0/0.terrain", "Accept-Encoding: gzip;q=0\r\n").body, "mesh");
}

TEST(ServeMaxAge, LetsClientsKeepTilesButNotWhatNamesThem) {
  const TemporaryFolder folder;
  write_tile_set(folder, "a");
  const RunningServer server({.data = {folder.path() / "a"}, .tiles_max_age_s = 600});
  EXPECT_EQ(request_raw(server.port(), "GET", "/tiles/0/0/0.glb").headers["cache-control"],
            "public, max-age=600");
  EXPECT_EQ(request_raw(server.port(), "GET", "/tileset.json").headers["cache-control"],
            "no-cache");
}

}  // namespace
}  // namespace terrane::viewer

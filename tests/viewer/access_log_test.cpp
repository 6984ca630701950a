#include "viewer/server/access_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "core/errors.h"
#include "tests/temporary_folder.h"
#include "tests/viewer/raw_http.h"
#include "tests/viewer/running_server.h"

namespace terrane::viewer {
namespace {

using ::testing::MatchesRegex;

// 1,000,000,000 s after the epoch is 2001-09-09 01:46:40 UTC.
TEST(AccessLogLine, IsInCombinedLogFormat) {
  EXPECT_EQ(to_line({.address = "192.0.2.7",
                     .method = "GET",
                     .target = "/tiles/0/1/2.glb",
                     .version = "HTTP/1.1",
                     .status = 206,
                     .bytes = 512,
                     .user_agent = "curl/7.88"},
                    1'000'000'000),
            "192.0.2.7 - - [09/Sep/2001:01:46:40 +0000] \"GET /tiles/0/1/2.glb HTTP/1.1\" 206 512 "
            "\"-\" \"curl/7.88\"\n");
}

TEST(AccessLogLine, CannotBeForgedByAClient) {
  const std::string line = to_line(
      {.address = "::1", .method = "GET", .target = "/\"\n1.2.3.4 - -", .user_agent = "\\"}, 0);
  EXPECT_EQ(line.find('\n'), line.size() - 1);
  EXPECT_NE(line.find("/\\x22\\x0A1.2.3.4"), std::string::npos);
  EXPECT_NE(line.find("\"\\x5C\""), std::string::npos);
}

TEST(AccessLog, HasALineForEachRequest) {
  const terrane::testing::TemporaryFolder folder;
  folder.write("served/a.glb", "abcdefghij");
  const auto log = folder.path() / "log";
  {
    const testing::RunningServer server({.data = {folder.path() / "served"}, .access_log = log});
    testing::request_raw(server.port(), "GET", "/a.glb", "Referer: http://x/\r\n");
    testing::request_raw(server.port(), "HEAD", "/a.glb");
    testing::request_raw(server.port(), "GET", "/none?q=1");
  }
  std::ifstream stream(log);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_THAT(lines[0], MatchesRegex("127.0.0.1 - - .* \"GET /a.glb HTTP/1.1\" 200 10 "
                                     "\"http://x/\" \"-\""));
  EXPECT_THAT(lines[1], MatchesRegex(".* \"HEAD /a.glb HTTP/1.1\" 200 0 \"-\" \"-\""));
  EXPECT_THAT(lines[2], MatchesRegex(".* \"GET /none.q=1 HTTP/1.1\" 404 .*"));
}

TEST(AccessLog, NamesTheFileThatCannotBeOpened) {
  EXPECT_THROW(AccessLog("/proc/none/log"), OutputError);
}

}  // namespace
}  // namespace terrane::viewer

#include "viewer/server/serve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>

#include <chrono>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include "core/errors.h"
#include "tests/temporary_folder.h"
#include "tests/viewer/gunzip.h"
#include "tests/viewer/raw_http.h"
#include "tests/viewer/running_server.h"

namespace terrane::viewer {
namespace {

namespace fs = std::filesystem;
using terrane::testing::TemporaryFolder;
using ::testing::HasSubstr;
using testing::RawAnswer;
using testing::request_raw;
using testing::RunningServer;

std::string long_json() {
  std::string json = "[";
  for (int i = 0; i < 20'000; ++i) json += std::to_string(i) + ",";
  return json + "0]";
}

class Serve : public ::testing::Test {
 protected:
  Serve() {
    outside_.write("secret.txt", "secret");
    outside_.write("served/index.html", "front page");
    outside_.write("served/letters.glb", "abcdefghij");
    outside_.write("served/empty.json", "");
    outside_.write("served/tileset.json", long_json());
    outside_.write("served/.work/state", "hidden");
  }

  RawAnswer get(const std::string& target, const std::string& header_lines = "") const {
    return request_raw(server_.port(), "GET", target, header_lines);
  }
  RawAnswer head(const std::string& target, const std::string& header_lines = "") const {
    return request_raw(server_.port(), "HEAD", target, header_lines);
  }

  TemporaryFolder outside_;
  RunningServer server_{
      {.data = {(fs::create_directories(outside_.path() / "served"), outside_.path() / "served")}}};
};

TEST_F(Serve, SendsAFileWithItsTypeAndForEveryOrigin) {
  RawAnswer answer = get("/letters.glb");
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.body, "abcdefghij");
  EXPECT_EQ(answer.headers["content-type"], "model/gltf-binary");
  EXPECT_EQ(answer.headers["content-length"], "10");
  EXPECT_EQ(answer.headers["access-control-allow-origin"], "*");
  EXPECT_EQ(answer.headers["cache-control"], "no-cache");
}

TEST_F(Serve, SendsTheFrontPageForTheFolder) {
  EXPECT_EQ(get("/").body, "front page");
  EXPECT_EQ(get("/?tolerance=2").body, "front page");
}

TEST_F(Serve, HeadHasTheHeadersOfGetAndNoBody) {
  for (const std::string& lines : {std::string(), std::string("Accept-Encoding: gzip\r\n")}) {
    const RawAnswer with_body = get("/tileset.json", lines);
    const RawAnswer without = head("/tileset.json", lines);
    EXPECT_EQ(without.status, 200);
    EXPECT_EQ(without.body, "");
    EXPECT_EQ(without.headers, with_body.headers);
  }
}

TEST_F(Serve, SendsAnEmptyFileAsEmpty) {
  RawAnswer answer = get("/empty.json", "Accept-Encoding: gzip\r\n");
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.headers["content-length"], "0");
  EXPECT_EQ(answer.body, "");
}

TEST_F(Serve, SendsALargeFileUnchanged) {
  std::string content(5'000'000, '\0');
  for (std::size_t i = 0; i < content.size(); ++i) content[i] = static_cast<char>(i * 31 >> 3);
  outside_.write("served/large.glb", content);
  EXPECT_TRUE(get("/large.glb").body == content);
  EXPECT_TRUE(get("/large.glb", "Range: bytes=999999-4000000\r\n").body ==
              content.substr(999'999, 3'000'002));
}

TEST_F(Serve, CompressesJsonForThoseWhoCanReadIt) {
  RawAnswer answer = get("/tileset.json", "Accept-Encoding: gzip, deflate, br\r\n");
  EXPECT_EQ(answer.headers["content-encoding"], "gzip");
  EXPECT_EQ(answer.headers["content-length"], std::to_string(answer.body.size()));
  EXPECT_EQ(answer.headers["vary"], "Accept-Encoding");
  EXPECT_EQ(testing::gunzip(answer.body, long_json().size()), long_json());

  RawAnswer plain = get("/tileset.json");
  EXPECT_EQ(plain.headers.count("content-encoding"), 0u);
  EXPECT_EQ(plain.headers["vary"], "Accept-Encoding");
  EXPECT_EQ(plain.body, long_json());
}

TEST_F(Serve, DoesNotCompressTiles) {
  EXPECT_EQ(get("/letters.glb", "Accept-Encoding: gzip, br\r\n").body, "abcdefghij");
}

TEST_F(Serve, AnswersNotModifiedToTheTagItGave) {
  for (const std::string& encoding : {std::string(), std::string("Accept-Encoding: gzip\r\n")}) {
    const std::string tag = get("/tileset.json", encoding).headers["etag"];
    for (const std::string& tags : {tag, "W/" + tag, "\"other\", " + tag, std::string("*")}) {
      RawAnswer again = get("/tileset.json", encoding + "If-None-Match: " + tags + "\r\n");
      EXPECT_EQ(again.status, 304) << tags;
      EXPECT_EQ(again.body, "");
      EXPECT_EQ(again.headers["etag"], tag);
      // RFC 9110, section 8.6: none, or that of the 200
      EXPECT_EQ(again.headers["content-length"],
                get("/tileset.json", encoding).headers["content-length"]);
    }
  }
}

TEST_F(Serve, PlainAndCompressedHaveDifferentTags) {
  const std::string plain = get("/tileset.json").headers["etag"];
  const std::string gzip = get("/tileset.json", "Accept-Encoding: gzip\r\n").headers["etag"];
  EXPECT_NE(plain, gzip);
  EXPECT_EQ(get("/tileset.json", "If-None-Match: " + gzip + "\r\n").status, 200);
}

TEST_F(Serve, SendsAFileAnewOnceItWasReplaced) {
  const std::string tag = get("/letters.glb").headers["etag"];
  outside_.write("served/letters.new", "ABCDEFGHIJ");  // of the same length
  fs::rename(outside_.path() / "served/letters.new", outside_.path() / "served/letters.glb");
  RawAnswer answer = get("/letters.glb", "If-None-Match: " + tag + "\r\n");
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.body, "ABCDEFGHIJ");
  EXPECT_NE(answer.headers["etag"], tag);
}

TEST_F(Serve, SendsTheBytesThatARangeNames) {
  RawAnswer answer = get("/letters.glb", "Range: bytes=2-4\r\n");
  EXPECT_EQ(answer.status, 206);
  EXPECT_EQ(answer.body, "cde");
  EXPECT_EQ(answer.headers["content-range"], "bytes 2-4/10");
  EXPECT_EQ(answer.headers["content-length"], "3");
  EXPECT_EQ(answer.headers["content-type"], "model/gltf-binary");

  RawAnswer last = get("/letters.glb", "Range: bytes=-3\r\n");
  EXPECT_EQ(last.body, "hij");
  EXPECT_EQ(last.headers["content-range"], "bytes 7-9/10");
}

TEST_F(Serve, ARangeCountsBytesOfThePlainFile) {
  RawAnswer answer = get("/tileset.json", "Range: bytes=0-3\r\nAccept-Encoding: gzip, br\r\n");
  EXPECT_EQ(answer.status, 206);
  EXPECT_EQ(answer.body, "[0,1");
  EXPECT_EQ(answer.headers.count("content-encoding"), 0u);
}

TEST_F(Serve, RefusesARangePastTheEndAndTellsTheSize) {
  RawAnswer answer = get("/letters.glb", "Range: bytes=10-\r\n");
  EXPECT_EQ(answer.status, 416);
  EXPECT_EQ(answer.headers["content-range"], "bytes */10");
  EXPECT_THAT(answer.body, Not(HasSubstr("abc")));
}

TEST_F(Serve, SendsTheWholeFileForRangesItDoesNotServe) {
  for (const char* range : {"bytes=1-2,4-5", "bytes=5-2", "letters=1-2", "bytes=x"}) {
    RawAnswer answer = get("/letters.glb", std::string("Range: ") + range + "\r\n");
    EXPECT_EQ(answer.status, 200) << range;
    EXPECT_EQ(answer.body, "abcdefghij") << range;
    EXPECT_EQ(answer.headers["content-type"], "model/gltf-binary") << range;
  }
}

TEST_F(Serve, ContinuesAnInterruptedDownloadOfTheSameFileOnly) {
  const std::string tag = get("/letters.glb").headers["etag"];
  EXPECT_EQ(get("/letters.glb", "Range: bytes=8-\r\nIf-Range: " + tag + "\r\n").body, "ij");
  EXPECT_EQ(get("/letters.glb", "Range: bytes=8-\r\nIf-Range: \"older\"\r\n").body, "abcdefghij");
}

TEST_F(Serve, NeverSendsAFileFromOutside) {
  const std::string absolute = (outside_.path() / "secret.txt").string();
  fs::create_symlink("../secret.txt", outside_.path() / "served/link.txt");
  fs::create_directory_symlink("..", outside_.path() / "served/up");
  for (const std::string& target : std::vector<std::string>{"/../secret.txt",
                                                            "/./../secret.txt",
                                                            "/x/../../secret.txt",
                                                            "/..%2fsecret.txt",
                                                            "/%2e%2e/secret.txt",
                                                            "/%2E%2E/secret.txt",
                                                            "/.%2e/secret.txt",
                                                            "/%252e%252e/secret.txt",
                                                            "/%252e%252e%252fsecret.txt",
                                                            "/%u002e%u002e/secret.txt",
                                                            "/%c0%ae%c0%ae/secret.txt",
                                                            "/..\\secret.txt",
                                                            "/..%5csecret.txt",
                                                            "/%5c..%5csecret.txt",
                                                            absolute,
                                                            "/" + absolute,
                                                            "/%2f" + absolute.substr(1),
                                                            "../secret.txt",
                                                            "secret.txt",
                                                            "http://localhost/../secret.txt",
                                                            "/index.html%00/../../secret.txt",
                                                            "/../secret.txt%00.glb",
                                                            "/link.txt",
                                                            "/up/secret.txt",
                                                            "/../served/../secret.txt",
                                                            "*"}) {
    const RawAnswer answer = get(target);
    EXPECT_TRUE(answer.status == 404 || answer.status == 400) << target << " " << answer.status;
    EXPECT_THAT(answer.body, Not(HasSubstr("secret"))) << target;
  }
}

TEST_F(Serve, SendsNothingFromBehindANulByte) {
  for (const char* before : {"/letters.glb", "/..", "/", "/none"}) {
    std::string request = std::string("GET ") + before;
    request += '\0';
    request += "/../secret.txt HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n";
    // the path ends at the NUL, for the checks and for the file alike
    EXPECT_THAT(testing::send_raw(server_.port(), request).body, Not(HasSubstr("secret")))
        << before;
  }
}

TEST_F(Serve, HidesFilesThatStartWithADot) {
  for (const char* target : {"/.work/state", "/%2ework/state", "/.work/", "/x/../.work/state"}) {
    EXPECT_EQ(get(target).status, 404) << target;
  }
}

TEST_F(Serve, AnswersAMissingFileWithAShortText) {
  RawAnswer answer = get("/none.glb");
  EXPECT_EQ(answer.status, 404);
  EXPECT_EQ(answer.body, "not found\n");
  EXPECT_EQ(answer.headers["content-type"], "text/plain; charset=utf-8");
  EXPECT_EQ(answer.headers["access-control-allow-origin"], "*");
}

TEST_F(Serve, IsReadOnly) {
  for (const char* method : {"POST", "PUT", "PATCH", "DELETE", "TRACE"}) {
    RawAnswer answer = request_raw(server_.port(), method, "/letters.glb",
                                   "Content-Type: text/plain\r\nContent-Length: 0\r\n");
    EXPECT_EQ(answer.status, 405) << method;
    EXPECT_EQ(answer.headers["allow"], "GET, HEAD, OPTIONS") << method;
  }
  EXPECT_EQ(get("/letters.glb").body, "abcdefghij");
}

TEST_F(Serve, TellsABrowserThatEveryOriginMayAsk) {
  RawAnswer answer = request_raw(server_.port(), "OPTIONS", "/letters.glb",
                                 "Origin: http://elsewhere\r\n"
                                 "Access-Control-Request-Method: GET\r\n"
                                 "Access-Control-Request-Headers: range\r\n");
  EXPECT_EQ(answer.status, 204);
  EXPECT_EQ(answer.headers["access-control-allow-origin"], "*");
  EXPECT_THAT(answer.headers["access-control-allow-methods"], HasSubstr("GET"));
  EXPECT_EQ(answer.headers["access-control-allow-headers"], "*");
}

TEST_F(Serve, SurvivesNonsense) {
  for (const std::string& request :
       {std::string("nonsense\r\n\r\n"), std::string("GET\r\n\r\n"),
        std::string("GET / HTTP/9.9\r\n\r\n"), std::string("GET / HTTP/1.1\r\n\r\n"),
        std::string("\x16\x03\x01\r\n\r\n"),
        "GET /" + std::string(20'000, 'a') + " HTTP/1.1\r\nConnection: close\r\n\r\n",
        "GET /" + std::string(5'000, '/') + " HTTP/1.1\r\nConnection: close\r\n\r\n",
        "GET / HTTP/1.1\r\nX: " + std::string(20'000, 'a') + "\r\nConnection: close\r\n\r\n"}) {
    const int status = testing::status_of_raw(server_.port(), request);
    const bool is_refused = (status >= 400 && status < 500) || status == 505;
    const bool is_hung_up_on = status == 0;
    EXPECT_TRUE(is_refused || is_hung_up_on) << status << ": " << request.substr(0, 20);
  }
  EXPECT_EQ(get("/letters.glb").status, 200);
}

TEST_F(Serve, TakesTheBodyOfARefusedRequestForNoRequest) {
  httplib::Client client("127.0.0.1", server_.port());
  client.set_keep_alive(true);
  std::string body;  // longer than httplib reads at once
  while (body.size() < 40'000) body += "GET /none.glb HTTP/1.1\r\n\r\n";
  const auto refused = client.Post("/letters.glb", body, "text/plain");
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->status, 405);
  const auto next = client.Get("/letters.glb");
  ASSERT_TRUE(next);
  EXPECT_EQ(next->status, 200);
  EXPECT_EQ(next->body, "abcdefghij");
}

TEST_F(Serve, KeepsAConnectionForManyRequests) {
  httplib::Client client("127.0.0.1", server_.port());
  client.set_keep_alive(true);
  client.set_tcp_nodelay(true);
  for (int i = 0; i < 200; ++i) {
    const auto answer = client.Get(i % 2 == 0 ? "/letters.glb" : "/none.glb");
    ASSERT_TRUE(answer) << i;
    EXPECT_EQ(answer->status, i % 2 == 0 ? 200 : 404);
    EXPECT_EQ(answer->has_header("Connection"), false);
  }
}

TEST_F(Serve, AnswersManyClientsAtOnce) {
  std::vector<std::future<int>> good_answers;
  for (int client = 0; client < 32; ++client) {
    good_answers.push_back(std::async(std::launch::async, [this] {
      int good = 0;
      for (int i = 0; i < 20; ++i) good += get("/letters.glb").body == "abcdefghij";
      return good;
    }));
  }
  for (auto& good : good_answers) EXPECT_EQ(good.get(), 20);
}

TEST(Server, TakesTheNextPortWhereOneIsTaken) {
  const TemporaryFolder folder;
  const Server first({.data = {folder.path()}, .port = 0});
  const Server second({.data = {folder.path()}, .port = first.port()});
  EXPECT_GT(second.port(), first.port());
  EXPECT_LE(second.port(), first.port() + 50);
  EXPECT_EQ(second.url(), "http://127.0.0.1:" + std::to_string(second.port()) + "/");
}

TEST(Server, NamesThePortThatIsTaken) {
  const TemporaryFolder folder;
  const Server first({.data = {folder.path()}, .port = 0});
  try {
    const Server second({.data = {folder.path()}, .port = first.port(), .next_free_port = false});
    FAIL() << "two servers on one port";
  } catch (const OutputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("127.0.0.1:" + std::to_string(first.port())));
    EXPECT_THAT(error.what(), HasSubstr("--port"));
  }
}

TEST(Server, RefusesAddressesOfOtherMachines) {
  const TemporaryFolder folder;
  // 192.0.2.0/24 is for documentation (RFC 5737): never an address of this machine
  EXPECT_THROW(Server({.data = {folder.path()}, .bind = "192.0.2.1", .port = 0}), OutputError);
}

TEST(Server, RefusesWhatIsNoFolder) {
  const TemporaryFolder folder;
  folder.write("file", "");
  EXPECT_THROW(Server({.data = {folder.path() / "none"}, .port = 0}), InputError);
  EXPECT_THROW(Server({.data = {folder.path() / "file"}, .port = 0}), InputError);
}

TEST(Server, RefusesWhatIsNoPort) {
  const TemporaryFolder folder;
  EXPECT_THROW(Server({.data = {folder.path()}, .port = -1}), ConfigError);
  EXPECT_THROW(Server({.data = {folder.path()}, .port = 65'536}), ConfigError);
}

TEST(Server, StopsEvenBeforeItRuns) {
  const TemporaryFolder folder;
  Server server({.data = {folder.path()}, .port = 0});
  server.stop();
  auto run = std::async(std::launch::async, [&server] { server.run(); });
  EXPECT_EQ(run.wait_for(std::chrono::seconds(10)), std::future_status::ready);
}

TEST(Server, StopsAtWhateverMomentItIsTold) {
  const TemporaryFolder folder;
  for (int i = 0; i < 30; ++i) {
    Server server({.data = {folder.path()}, .port = 0});
    auto run = std::async(std::launch::async, [&server] { server.run(); });
    std::this_thread::sleep_for(std::chrono::microseconds(i * 20));
    server.stop();
    ASSERT_EQ(run.wait_for(std::chrono::seconds(10)), std::future_status::ready) << i;
  }
}

TEST(Server, GivesItsPortBack) {
  const TemporaryFolder folder;
  int port = 0;
  {
    const RunningServer server({.data = {folder.path()}});
    port = server.port();
    EXPECT_EQ(request_raw(port, "GET", "/none").status, 404);
  }
  const Server next({.data = {folder.path()}, .port = port, .next_free_port = false});
  EXPECT_EQ(next.port(), port);
}

}  // namespace
}  // namespace terrane::viewer

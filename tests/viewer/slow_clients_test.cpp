// Clients that do not come to the point, or are many, must not keep others waiting.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/temporary_folder.h"
#include "tests/viewer/gunzip.h"
#include "tests/viewer/raw_http.h"
#include "tests/viewer/running_server.h"

namespace terrane::viewer {
namespace {

using terrane::testing::TemporaryFolder;
using testing::request_raw;
using testing::RunningServer;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
using std::chrono::seconds;

/// A TCP connection of this test to a server.
class Line {
 public:
  explicit Line(int port) : descriptor_(::socket(AF_INET, SOCK_STREAM, 0)) {
    const timeval patience = {.tv_sec = 20, .tv_usec = 0};
    ::setsockopt(descriptor_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    is_open_ =
        ::connect(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }
  ~Line() { ::close(descriptor_); }
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

  bool is_open() const { return is_open_; }
  bool send(const std::string& bytes) const {
    return ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL) ==
           static_cast<ssize_t>(bytes.size());
  }
  /// At most so many bytes; empty at the end.
  std::string receive(std::size_t most) const {
    std::string bytes(most, '\0');
    const ssize_t got = ::recv(descriptor_, bytes.data(), most, 0);
    bytes.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    return bytes;
  }

 private:
  int descriptor_;
  bool is_open_ = false;
};

std::vector<std::unique_ptr<Line>> many_lines(int count, int port, const std::string& first_words) {
  std::vector<std::unique_ptr<Line>> lines;
  for (int i = 0; i < count; ++i) {
    lines.push_back(std::make_unique<Line>(port));
    EXPECT_TRUE(lines.back()->is_open());
    if (!first_words.empty()) lines.back()->send(first_words);
  }
  return lines;
}

class SlowClients : public ::testing::Test {
 protected:
  SlowClients() { folder_.write("a.glb", std::string(20'000, 'a')); }

  ServeOptions options() const { return {.data = {folder_.path()}}; }

  static void expect_quick_answers(int port) {
    const auto begin = Clock::now();
    for (int i = 0; i < 20; ++i) {
      ASSERT_EQ(request_raw(port, "GET", "/a.glb").body.size(), 20'000u);
    }
    EXPECT_LT(Clock::now() - begin, seconds(2));
  }

  TemporaryFolder folder_;
};

TEST_F(SlowClients, DoNotBlockOthersHoweverManyTheyAre) {
  const RunningServer server(options());
  const auto slow = many_lines(400, server.port(), "GET /a.glb HTTP/1.1\r\nHost: x\r\nX-Slow: ");
  expect_quick_answers(server.port());
}

TEST_F(SlowClients, IdleOnesDoNotBlockOthers) {
  const RunningServer server(options());
  const auto idle = many_lines(400, server.port(), "");
  expect_quick_answers(server.port());
}

TEST_F(SlowClients, AreHungUpOnThoughTheySendAByteNowAndThen) {
  ServeOptions impatient = options();
  impatient.patience_ms = 700;
  const RunningServer server(impatient);
  const Line slow(server.port());
  slow.send("GET /a.glb HTTP/1.1\r\n");
  const auto begin = Clock::now();
  while (Clock::now() - begin < seconds(10) && slow.send("X: y\r\n")) {
    std::this_thread::sleep_for(milliseconds(50));
  }
  EXPECT_LT(Clock::now() - begin, seconds(5));
  EXPECT_EQ(slow.receive(100), "");
}

TEST_F(SlowClients, AreHungUpOnInTheMiddleOfAnUpload) {
  ServeOptions impatient = options();
  impatient.patience_ms = 700;
  const RunningServer server(impatient);
  const Line slow(server.port());
  slow.send("POST /a.glb HTTP/1.1\r\nHost: x\r\nContent-Length: 60000\r\n\r\n");
  const auto begin = Clock::now();
  while (Clock::now() - begin < seconds(10) && slow.send("y")) {
    std::this_thread::sleep_for(milliseconds(50));
  }
  EXPECT_LT(Clock::now() - begin, seconds(5));
}

TEST_F(SlowClients, GiveWayWhereAllConnectionsAreTaken) {
  ServeOptions small = options();
  small.connections = 16;
  const RunningServer server(small);  // its usual patience is 15 s
  const auto idle = many_lines(40, server.port(), "");
  const auto begin = Clock::now();
  EXPECT_EQ(request_raw(server.port(), "GET", "/a.glb").status, 200);
  EXPECT_LT(Clock::now() - begin, seconds(10));
}

TEST_F(SlowClients, MaySendHeadersOfALimitedSizeOnly) {
  const RunningServer server(options());
  const Line greedy(server.port());
  greedy.send("GET /a.glb HTTP/1.1\r\nHost: x\r\n");
  int sent = 0;
  while (sent < 1000 && greedy.send("X-Header: " + std::string(100, 'x') + "\r\n")) ++sent;
  const std::string answer = greedy.receive(100);
  EXPECT_TRUE(answer.empty() || answer.starts_with("HTTP/1.1 431")) << answer;
  expect_quick_answers(server.port());
}

TEST_F(SlowClients, ReadersDoNotBlockOthers) {
  folder_.write("large.glb", std::string(30'000'000, 'l'));
  const RunningServer server(options());
  const auto readers = many_lines(50, server.port(),
                                  "GET /large.glb HTTP/1.1\r\nHost: x\r\n\r\n");  // and never read
  expect_quick_answers(server.port());
}

// zlib's level 4 makes some 60 MB/s of this: half a second for each of the four.
TEST_F(SlowClients, WhoWantLargeTextsCompressedDoNotBlockOthers) {
  std::string text;
  for (std::int64_t i = 0; text.size() < 30'000'000; ++i) text += std::to_string(i * 7919) + ",";
  for (const char* name : {"1.json", "2.json", "3.json", "4.json"}) folder_.write(name, text);
  const RunningServer server(options());
  std::vector<std::future<testing::RawAnswer>> large;
  for (const char* target : {"/1.json", "/2.json", "/3.json", "/4.json"}) {
    large.push_back(std::async(std::launch::async, [&server, target] {
      return request_raw(server.port(), "GET", target, "Accept-Encoding: gzip\r\n");
    }));
  }
  std::this_thread::sleep_for(milliseconds(100));  // all are under way
  expect_quick_answers(server.port());
  for (auto& answer : large) {
    const testing::RawAnswer got = answer.get();
    EXPECT_EQ(got.headers.at("content-encoding"), "gzip");
    EXPECT_TRUE(testing::gunzip(got.body, text.size()) == text);
  }
}

TEST_F(SlowClients, WhoWantLargeTextsCompressedDoNotKeepTheServerFromStopping) {
  folder_.write("large.json", std::string(30'000'000, ' '));
  Server server({.data = {folder_.path()}, .port = 0});
  auto run = std::async(std::launch::async, [&server] { server.run(); });
  const auto waiting = many_lines(
      3, server.port(), "GET /large.json HTTP/1.1\r\nHost: x\r\nAccept-Encoding: gzip\r\n\r\n");
  std::this_thread::sleep_for(milliseconds(50));
  server.stop();
  EXPECT_EQ(run.wait_for(seconds(15)), std::future_status::ready);
}

TEST_F(SlowClients, GetTheRestOfAnAnswerWhenTheServerStops) {
  const std::string content(20'000'000, 'l');
  folder_.write("large.glb", content);
  RunningServer server(options());
  const Line reader(server.port());
  reader.send("GET /large.glb HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
  std::string received = reader.receive(1000);  // it has begun
  server.stop();
  std::this_thread::sleep_for(milliseconds(200));
  for (std::string more; !(more = reader.receive(1 << 20)).empty();) received += more;
  EXPECT_EQ(received.size() - received.find("\r\n\r\n") - 4, content.size());
}

TEST_F(SlowClients, IdleOnesDoNotKeepTheServerFromStopping) {
  const TemporaryFolder folder;
  Server server({.data = {folder_.path()}, .port = 0});
  auto run = std::async(std::launch::async, [&server] { server.run(); });
  const auto idle = many_lines(20, server.port(), "GET /a.glb HTT");
  server.stop();
  EXPECT_EQ(run.wait_for(seconds(5)), std::future_status::ready);
}

}  // namespace
}  // namespace terrane::viewer

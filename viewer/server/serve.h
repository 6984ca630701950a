#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace terrane::viewer {

/// What is served, where, and within which limits.
struct ServeOptions {
  std::vector<std::filesystem::path> data;  ///< output folders, archives, trees; at least one
  std::string bind = "127.0.0.1";    ///< address or host name of this machine; 0.0.0.0 for everyone
  int port = 8080;                   ///< 0 to 65535; 0 takes any free one
  bool next_free_port = true;        ///< where the port is taken, try the 50 that follow it
  std::filesystem::path access_log;  ///< file that a line is appended to for each request; or none
  int tiles_max_age_s = 0;           ///< how long clients may keep tiles without asking again
  int connections = 1000;            ///< at the same time, 8 to 100,000; others wait
  int patience_ms = 15'000;  ///< a client has so long for a request, from its last answer on
};

/// Serves output folders and archives over HTTP, read-only.
///
/// Guarantees: only regular files that really lie in the folders are sent, wherever `..`, encoded
/// characters or symbolic links in a request point to; files and folders whose name starts with a
/// dot are never sent. A file that was replaced shows at the next request (ETag, no-cache).
/// A request's head is at most 16 kB; who is slower is hung up on, and after 1 s
/// where three quarters of the connections are in use.
class Server {
 public:
  /// Takes the port; requests wait until run().
  ///
  /// \throws InputError if a path is no folder and no archive; ConfigError if a number is out of
  ///         range; OutputError if no port could be taken, or the log not be opened.
  explicit Server(const ServeOptions& options);

  /// \pre run() has returned, or was never called.
  ~Server();

  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Where a browser on this machine finds it: "http://127.0.0.1:8080/".
  std::string url() const;
  int port() const;

  /// Addresses of the data sets, in the order of the options.
  std::vector<std::string> data_urls() const;

  /// Answers requests until stop(). Called once.
  /// \throws OutputError if the system gives no threads.
  void run();

  /// Ends run(), also one that has not begun yet; thread-safe, but not for signal handlers.
  /// No client is let in from then on; run() returns when the answers under way are sent, or after
  /// 10 s.
  void stop();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace terrane::viewer

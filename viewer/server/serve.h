#pragma once

#include <filesystem>
#include <memory>
#include <string>

namespace terrane::viewer {

/// What is served, and where.
struct ServeOptions {
  std::filesystem::path folder;
  std::string bind = "127.0.0.1";  ///< address or host name of this machine; 0.0.0.0 for everyone
  int port = 8080;                 ///< 0 to 65535; 0 takes any free one
  bool next_free_port = true;      ///< where the port is taken, try the 50 that follow it
};

/// Serves the files of one folder over HTTP, read-only.
///
/// Guarantees: only regular files that really lie in the folder are sent, wherever `..`, encoded
/// characters or symbolic links in a request point to; files and folders whose name starts with a
/// dot are never sent. A file that was replaced shows at the next request (ETag, no-cache).
class Server {
 public:
  /// Takes the port; requests wait until run().
  ///
  /// \throws InputError if the folder is not there; ConfigError if the port is out of range;
  ///         OutputError if no port could be taken.
  explicit Server(const ServeOptions& options);

  /// \pre run() has returned, or was never called.
  ~Server();

  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Where a browser on this machine finds it: "http://127.0.0.1:8080/".
  std::string url() const;
  int port() const;

  /// Answers requests until stop(). Called once.
  void run();

  /// Ends run(), also one that has not begun yet; thread-safe, but not for signal handlers.
  /// run() returns when the requests under way are answered and idle clients are given up (2 s).
  void stop();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace terrane::viewer

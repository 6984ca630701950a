#pragma once

#include <memory>

#include "viewer/server/access_log.h"
#include "viewer/server/file_answer.h"
#include "viewer/server/listening_socket.h"
#include "viewer/server/site.h"

namespace terrane::viewer {

struct HttpDaemonOptions {
  int connections = 1000;    ///< at the same time; others wait
  int patience_ms = 15'000;  ///< for a request's head and body, from the last answer on
  FileRules rules;
  AccessLog* log = nullptr;  ///< may be null
};

/// HTTP/1.1 over libmicrohttpd: a few threads, each of which waits for many connections at once, so
/// that an idle client costs a descriptor and no thread.
class HttpDaemon {
 public:
  /// Begins to answer.
  ///
  /// \param socket  closed by finish() or the end of the daemon.
  /// \param site    outlives the daemon.
  /// \throws OutputError if the system gives no threads or descriptors.
  HttpDaemon(ListeningSocket& socket, const Site& site, const HttpDaemonOptions& options);
  ~HttpDaemon();
  HttpDaemon(const HttpDaemon&) = delete;
  HttpDaemon& operator=(const HttpDaemon&) = delete;

  /// Lets nobody in any more, and waits up to 10 s for the answers under way.
  void finish();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace terrane::viewer

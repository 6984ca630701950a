#pragma once

#include <thread>

#include "viewer/server/serve.h"

namespace terrane::viewer::testing {

/// A server on a free port, running in a thread of its own until the end of the scope.
class RunningServer {
 public:
  explicit RunningServer(ServeOptions options)
      : server_(with_free_port(std::move(options))), thread_([this] { server_.run(); }) {}
  ~RunningServer() {
    server_.stop();
    thread_.join();
  }
  RunningServer(const RunningServer&) = delete;
  RunningServer& operator=(const RunningServer&) = delete;

  int port() const { return server_.port(); }
  const Server& server() const { return server_; }
  void stop() { server_.stop(); }

 private:
  static ServeOptions with_free_port(ServeOptions options) {
    options.port = 0;
    return options;
  }

  Server server_;
  std::thread thread_;
};

}  // namespace terrane::viewer::testing

#include "viewer/server/serve.h"

#include <fmt/format.h>
#include <unistd.h>

#include <condition_variable>
#include <mutex>

#include "core/errors.h"
#include "viewer/server/http_daemon.h"
#include "viewer/server/listening_socket.h"

namespace terrane::viewer {
namespace {

constexpr int kPortsToTry = 51;
constexpr int kFewestConnections = 8;
constexpr int kMostConnections = 100'000;

bool is_wildcard(const std::string& host) { return host == "0.0.0.0" || host == "::"; }

// A wildcard is no address to go to; an IPv6 address needs brackets.
std::string host_in_url(const std::string& host) {
  if (is_wildcard(host)) return "127.0.0.1";
  return host.find(':') == std::string::npos ? host : "[" + host + "]";
}

const ServeOptions& checked(const ServeOptions& options) {
  if (options.data.empty()) {
    throw ConfigError("nothing to serve: give a folder or an archive");
  }
  if (options.connections < kFewestConnections || options.connections > kMostConnections) {
    throw ConfigError(fmt::format("{} connections: out of range. Give {} to {}",
                                  options.connections, kFewestConnections, kMostConnections));
  }
  return options;
}

}  // namespace

class Server::Impl {
 public:
  explicit Impl(const ServeOptions& options)
      : options_(checked(options)),
        site_(options.data),
        log_(options.access_log.empty() ? nullptr
                                        : std::make_unique<AccessLog>(options.access_log)),
        socket_(options.bind, options.port, options.next_free_port ? kPortsToTry : 1) {}

  std::string url() const {
    return fmt::format("http://{}:{}/", host_in_url(options_.bind), socket_.port());
  }
  int port() const { return socket_.port(); }
  const Site& site() const { return site_; }

  void run() {
    {
      std::unique_lock lock(mutex_);
      if (must_stop_) return;
    }
    HttpDaemon daemon(socket_, site_,
                      {.connections = options_.connections,
                       .patience_ms = options_.patience_ms,
                       .rules = {.tiles_max_age_s = options_.tiles_max_age_s},
                       .log = log_.get()});
    std::unique_lock lock(mutex_);
    stopped_.wait(lock, [this] { return must_stop_; });
    lock.unlock();
    daemon.finish();
  }

  void stop() {
    {
      const std::scoped_lock lock(mutex_);
      must_stop_ = true;
    }
    stopped_.notify_all();
  }

 private:
  ServeOptions options_;
  Site site_;
  std::unique_ptr<AccessLog> log_;
  ListeningSocket socket_;
  std::mutex mutex_;
  std::condition_variable stopped_;
  bool must_stop_ = false;
};

Server::Server(const ServeOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Server::~Server() = default;

std::string Server::url() const { return impl_->url(); }
int Server::port() const { return impl_->port(); }
void Server::run() { impl_->run(); }
void Server::stop() { impl_->stop(); }

std::vector<std::string> Server::data_urls() const {
  std::vector<std::string> urls;
  for (const std::string& path : impl_->site().paths()) urls.push_back(url() + path.substr(1));
  return urls;
}

}  // namespace terrane::viewer

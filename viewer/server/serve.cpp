#include "viewer/server/serve.h"

#include <fmt/format.h>
#include <httplib.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <thread>

#include "core/errors.h"
#include "viewer/server/file_answer.h"

namespace terrane::viewer {
namespace {

namespace fs = std::filesystem;

constexpr int kPortsToTry = 51;
constexpr int kLargestPort = 65535;
// Every idle keep-alive client holds a thread until its time is over.
constexpr std::size_t kThreads = 64;
constexpr int kIdleTimeout_s = 2;
constexpr std::size_t kRequestsPerConnection = 100'000;
// httplib asks for 5, and a browser that opens more at once waits a second for a lost SYN.
constexpr int kListenBacklog = 256;
constexpr std::size_t kLargestRequestBodyBytes = 1 << 16;
constexpr std::uint64_t kReadAtOnceBytes = 1 << 18;

FileRequest file_request(const httplib::Request& request) {
  return {.method = request.method,
          .path = request.path,
          .accept_encoding = request.get_header_value("Accept-Encoding"),
          .if_none_match = request.get_header_value("If-None-Match"),
          .if_range = request.get_header_value("If-Range"),
          .range = request.get_header_value("Range")};
}

void stream_part(const FilePart& part, httplib::Response& response) {
  response.set_content_provider(
      response.get_header_value("Content-Type"), [part](std::size_t sent, httplib::DataSink& sink) {
        const std::uint64_t left = part.range.length - sent;
        const std::string piece =
            part.file->read(part.range.offset + sent, std::min(left, kReadAtOnceBytes));
        if (piece.empty() || !sink.write(piece.data(), piece.size())) return false;
        if (piece.size() == left) sink.done();
        return true;
      });
}

void fill_response(FileAnswer answer, bool with_body, httplib::Response& response) {
  response.status = answer.status;
  response.headers.clear();
  for (auto& [name, value] : answer.headers) response.headers.emplace(name, std::move(value));
  if (!with_body) return;
  if (auto* text = std::get_if<std::string>(&answer.body)) {
    response.body = std::move(*text);
  } else if (const auto& part = std::get<FilePart>(answer.body); part.range.length > 0) {
    stream_part(part, response);
  }
}

// httplib adds a length of 0, which would be the file's own in a 304 and is forbidden in a 204.
void remove_length_without_body(const httplib::Request&, httplib::Response& response) {
  if (response.status == 204 || response.status == 304) response.headers.erase("Content-Length");
}

bool is_wildcard(const std::string& host) { return host == "0.0.0.0" || host == "::"; }

// A wildcard is no address to go to; an IPv6 address needs brackets.
std::string host_in_url(const std::string& host) {
  if (is_wildcard(host)) return "127.0.0.1";
  return host.find(':') == std::string::npos ? host : "[" + host + "]";
}

}  // namespace

class Server::Impl {
 public:
  explicit Impl(const ServeOptions& options) : bind_(options.bind) {
    open_folder(options.folder);
    configure();
    take_port(options);
    ::listen(socket_, kListenBacklog);
  }

  ~Impl() {
    if (!has_begun_) ::close(socket_);  // httplib closes what it has listened on
  }

  const std::string& bind() const { return bind_; }
  int port() const { return port_; }

  void run() {
    has_begun_ = true;
    if (must_stop_) {
      ::close(socket_);
    } else {
      http_.listen_after_bind();
    }
    has_ended_ = true;
  }

  void stop() {
    must_stop_ = true;
    // run() has seen no must_stop_, but httplib may not be listening yet: it would miss its stop()
    while (has_begun_ && !has_ended_ && !http_.is_running()) std::this_thread::yield();
    http_.stop();
  }

 private:
  void open_folder(const fs::path& folder) {
    std::error_code error;
    root_ = fs::canonical(folder, error);
    if (error || !fs::is_directory(root_, error)) {
      throw InputError(fmt::format("{}: no such folder. Give the folder that 'terrane build' wrote",
                                   folder.string()));
    }
  }

  void configure() {
    http_.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
    http_.set_tcp_nodelay(true);
    http_.set_keep_alive_max_count(kRequestsPerConnection);
    http_.set_keep_alive_timeout(kIdleTimeout_s);
    http_.set_payload_max_length(kLargestRequestBodyBytes);
    http_.set_socket_options([this](int socket) { prepare(socket); });
    // "Unhandled" and no route behind it: httplib then sends the response as it is. What it
    // counts as handled it compresses (Brotli first) and cuts into ranges by rules of its own.
    http_.set_pre_routing_handler([this](const httplib::Request& request, auto& response) {
      answer(file_request(request), response);
      return httplib::Server::HandlerResponse::Unhandled;
    });
    const httplib::Server::HandlerWithResponse on_error = [this](const auto& request,
                                                                 auto& response) {
      answer_error(request, response);
      return httplib::Server::HandlerResponse::Unhandled;
    };
    http_.set_error_handler(on_error);
    http_.set_exception_handler(
        [](const httplib::Request&, auto& response, auto) { response.status = 500; });
    http_.set_post_routing_handler(remove_length_without_body);
  }

  // httplib's own choice, SO_REUSEPORT, lets two servers take the same port.
  void prepare(int socket) {
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    socket_ = socket;
  }

  void answer(const FileRequest& request, httplib::Response& response) {
    fill_response(answer_file_request(root_, request), request.method != "HEAD", response);
  }

  // httplib refuses some requests before our handler sees them.
  void answer_error(const httplib::Request& request, httplib::Response& response) {
    const bool is_ours = response.has_header("Access-Control-Allow-Origin");
    const bool is_strange_method = is_ours && response.status == 400;
    const bool is_strange_range = !is_ours && response.status == 416;
    if (is_strange_method || is_strange_range) {
      FileRequest again = file_request(request);
      again.range.clear();
      return answer(again, response);
    }
    if (is_ours) return;
    response.set_header("Content-Type", "text/plain; charset=utf-8");
    response.body = fmt::format("error {}\n", response.status);
    response.set_header("Content-Length", std::to_string(response.body.size()));
  }

  void take_port(const ServeOptions& options) {
    if (options.port < 0 || options.port > kLargestPort) {
      throw ConfigError(
          fmt::format("port {}: not a port. Give one from 0 to {}", options.port, kLargestPort));
    }
    const int ports = options.next_free_port && options.port != 0 ? kPortsToTry : 1;
    const int last = std::min(options.port + ports - 1, kLargestPort);
    for (int port = options.port; port <= last; ++port) {
      errno = 0;
      if (try_port(port)) return;
      if (errno != EADDRINUSE) break;
    }
    throw OutputError(fmt::format(
        "{}:{}: cannot serve there ({}). Choose another port with --port or address with --bind",
        bind_,
        last == options.port ? fmt::to_string(last) : fmt::format("{}-{}", options.port, last),
        errno == 0 ? "no such address" : std::strerror(errno)));
  }

  bool try_port(int port) {
    if (port == 0) {
      port_ = http_.bind_to_any_port(bind_);
      return port_ > 0;
    }
    port_ = port;
    return http_.bind_to_port(bind_, port);
  }

  fs::path root_;
  std::string bind_;
  httplib::Server http_;
  int socket_ = -1;
  int port_ = 0;
  std::atomic<bool> must_stop_ = false;
  std::atomic<bool> has_begun_ = false;
  std::atomic<bool> has_ended_ = false;
};

Server::Server(const ServeOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Server::~Server() = default;

std::string Server::url() const {
  return fmt::format("http://{}:{}/", host_in_url(impl_->bind()), impl_->port());
}

int Server::port() const { return impl_->port(); }
void Server::run() { impl_->run(); }
void Server::stop() { impl_->stop(); }

}  // namespace terrane::viewer

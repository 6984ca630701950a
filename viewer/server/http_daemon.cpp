#include "viewer/server/http_daemon.h"

#include <arpa/inet.h>
#include <microhttpd.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <string>
#include <thread>

#include "core/errors.h"
#include "viewer/server/background_jobs.h"
#include "viewer/server/waiting_clients.h"

namespace terrane::viewer {
namespace {

constexpr std::uint64_t kCacheBytes = 128 << 20;
// the head of a request, and of its answer
constexpr std::size_t kMemoryPerConnection = 16 << 10;
constexpr unsigned int kStalledTimeout_s = 30;
constexpr std::uint64_t kLargestUploadBytes = 1 << 16;
// larger contents are sent by the kernel from the file
constexpr std::uint64_t kReadAtOnceBytes = 1 << 18;
constexpr auto kGrace = std::chrono::seconds(10);

/// A connection, for as long as it is open; one request after the other.
struct Connection {
  WaitingClient* client = nullptr;
  std::string target;  ///< of the request under way, as it came
  std::uint64_t uploaded_bytes = 0;
  bool is_begun = false;     ///< the request's head is there, its answer is not sent yet
  bool is_prepared = false;  ///< what takes time for the answer was done
  AccessRecord record;
};

Connection& connection_of(MHD_Connection* connection) {
  const auto* info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_SOCKET_CONTEXT);
  return *static_cast<Connection*>(info->socket_context);
}

std::string header_of(MHD_Connection* connection, const char* name) {
  const char* value = MHD_lookup_connection_value(connection, MHD_HEADER_KIND, name);
  return value == nullptr ? "" : value;
}

std::string address_of(MHD_Connection* connection) {
  const auto* info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CLIENT_ADDRESS);
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (info->client_addr->sa_family == AF_INET6) {
    const auto* address = reinterpret_cast<const sockaddr_in6*>(info->client_addr);
    ::inet_ntop(AF_INET6, &address->sin6_addr, text.data(), text.size());
  } else {
    const auto* address = reinterpret_cast<const sockaddr_in*>(info->client_addr);
    ::inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size());
  }
  return text.data();
}

bool has_body(const char* method, int status) {
  return std::strcmp(method, "HEAD") != 0 && status != 304;
}

FileRequest file_request(MHD_Connection* connection, const char* method, const char* version,
                         const std::string& target) {
  return {.method = method,
          .target = target,
          .version = version,
          .has_host = !header_of(connection, "Host").empty(),
          .accept_encoding = header_of(connection, "Accept-Encoding"),
          .if_none_match = header_of(connection, "If-None-Match"),
          .if_range = header_of(connection, "If-Range"),
          .range = header_of(connection, "Range")};
}

MHD_Response* response_of_text(std::shared_ptr<const std::string> text, const FileContent& part) {
  const auto* bytes = text->data() + part.offset();
  auto* keeper = new std::shared_ptr<const std::string>(std::move(text));
  return MHD_create_response_from_buffer_with_free_callback_cls(
      part.bytes(), const_cast<char*>(bytes),  // MHD's interface predates const
      [](void* kept) { delete static_cast<std::shared_ptr<const std::string>*>(kept); }, keeper);
}

/// Null if the file shrank meanwhile.
MHD_Response* response_of(const FileContent& content, bool needs_body) {
  if (content.bytes() == 0) {
    return MHD_create_response_from_buffer(0, nullptr, MHD_RESPMEM_PERSISTENT);
  }
  if (content.text()) return response_of_text(content.text(), content);
  if (needs_body && content.bytes() <= kReadAtOnceBytes) {
    auto text = std::make_shared<const std::string>(content.read_all());
    if (text->size() != content.bytes()) return nullptr;
    return response_of_text(text, FileContent(text));
  }
  // the response closes its own descriptor
  return MHD_create_response_from_fd_at_offset64(
      content.bytes(), ::dup(content.file()->descriptor()), content.offset());
}

void raise_descriptor_limit(int connections) {
  rlimit limit = {};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  // each connection may have a file open
  const auto wanted = static_cast<rlim_t>(2 * connections + 256);
  if (limit.rlim_cur >= wanted) return;
  limit.rlim_cur = std::min(wanted, limit.rlim_max);
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

}  // namespace

class HttpDaemon::Impl {
 public:
  Impl(ListeningSocket& socket, const Site& site, const HttpDaemonOptions& options)
      : site_(site),
        options_(options),
        cache_(kCacheBytes),
        clients_({.usual = std::chrono::milliseconds(options.patience_ms),
                  .crowd = static_cast<std::size_t>(options.connections) * 3 / 4}) {
    raise_descriptor_limit(options.connections);
    start(socket);
  }

  ~Impl() { stop(); }

  void finish() {
    listening_ = MHD_quiesce_daemon(daemon_);
    // clients that knock now are refused at once, and do not wait for a server that goes
    if (listening_ >= 0) ::shutdown(listening_, SHUT_RDWR);
    const auto end = std::chrono::steady_clock::now() + kGrace;
    while (under_way_ > 0 && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    stop();
  }

 private:
  void start(ListeningSocket& socket) {
    const unsigned int threads = std::clamp(std::thread::hardware_concurrency(), 2U, 16U);
    unsigned int flags = MHD_USE_EPOLL_INTERNAL_THREAD | MHD_ALLOW_SUSPEND_RESUME;
    if (socket.is_ipv6()) flags |= MHD_USE_IPv6;
    daemon_ = MHD_start_daemon(flags, 0, nullptr, nullptr, &Impl::on_request, this,  //
                               MHD_OPTION_LISTEN_SOCKET, socket.descriptor(),        //
                               MHD_OPTION_THREAD_POOL_SIZE, threads,                 //
                               MHD_OPTION_CONNECTION_LIMIT,
                               static_cast<unsigned int>(options_.connections),               //
                               MHD_OPTION_CONNECTION_TIMEOUT, kStalledTimeout_s,              //
                               MHD_OPTION_CONNECTION_MEMORY_LIMIT, kMemoryPerConnection,      //
                               MHD_OPTION_URI_LOG_CALLBACK, &Impl::on_target, this,           //
                               MHD_OPTION_UNESCAPE_CALLBACK, &Impl::leave_as_it_is, nullptr,  //
                               MHD_OPTION_NOTIFY_CONNECTION, &Impl::on_connection, this,      //
                               MHD_OPTION_NOTIFY_COMPLETED, &Impl::on_completed, this,        //
                               MHD_OPTION_END);
    if (daemon_ == nullptr) {
      throw OutputError(
          "the server cannot start: the system gives no threads or descriptors. Raise the limits "
          "(ulimit -n, -u) or give fewer --connections");
    }
    socket.release();
  }

  void stop() {
    if (daemon_ == nullptr) return;
    jobs_.end();  // no connection may rest any more
    MHD_stop_daemon(daemon_);
    daemon_ = nullptr;
    // only now may nobody use it any more
    if (listening_ >= 0) ::close(listening_);
  }

  // paths are decoded by our own rules
  static std::size_t leave_as_it_is(void*, MHD_Connection*, char* text) {
    return std::strlen(text);
  }

  static void on_connection(void* self, MHD_Connection* connection, void** context,
                            MHD_ConnectionNotificationCode code) {
    auto& clients = static_cast<Impl*>(self)->clients_;
    if (code == MHD_CONNECTION_NOTIFY_CLOSED) {
      const auto* closed = static_cast<Connection*>(*context);
      clients.remove(closed->client);
      delete closed;
      return;
    }
    const auto* info = MHD_get_connection_info(connection, MHD_CONNECTION_INFO_CONNECTION_FD);
    *context = new Connection{.client = clients.add(info->connect_fd)};
  }

  static void* on_target(void*, const char* target, MHD_Connection* connection) {
    connection_of(connection).target = target;
    return nullptr;
  }

  static MHD_Result on_request(void* self, MHD_Connection* connection, const char*,
                               const char* method, const char* version, const char*,
                               std::size_t* upload_bytes, void**) {
    return static_cast<Impl*>(self)->take(connection, method, version, upload_bytes);
  }

  /// Called once with the head, then for each piece of a body, then without: the time to answer.
  MHD_Result take(MHD_Connection* handle, const char* method, const char* version,
                  std::size_t* upload_bytes) {
    Connection& connection = connection_of(handle);
    if (!connection.is_begun) {
      connection.is_begun = true;
      connection.uploaded_bytes = 0;
      ++under_way_;
      return MHD_YES;
    }
    if (*upload_bytes > 0) {
      connection.uploaded_bytes += *upload_bytes;
      *upload_bytes = 0;
      return connection.uploaded_bytes > kLargestUploadBytes ? MHD_NO : MHD_YES;
    }
    connection.client->has_asked();
    return answer(connection, handle, method, version);
  }

  MHD_Result answer(Connection& connection, MHD_Connection* handle, const char* method,
                    const char* version) {
    FileRequest request = file_request(handle, method, version, connection.target);
    request.must_be_quick = !connection.is_prepared;
    FileAnswer answer = answer_file_request(site_, request, options_.rules, cache_);
    if (answer.status == FileAnswer::kTakesTime) return prepare(connection, handle, request);
    MHD_Response* response = response_of(answer.body, has_body(method, answer.status));
    if (response == nullptr) return MHD_NO;
    for (const auto& [name, value] : answer.headers) {
      MHD_add_response_header(response, name.c_str(), value.c_str());
    }
    const MHD_Result is_queued =
        MHD_queue_response(handle, static_cast<unsigned int>(answer.status), response);
    MHD_destroy_response(response);
    if (options_.log != nullptr) note(connection, handle, method, version, answer);
    return is_queued;
  }

  /// Lets the connection rest until the answer is in the cache; then it is asked for again.
  MHD_Result prepare(Connection& connection, MHD_Connection* handle, FileRequest request) {
    connection.is_prepared = true;
    request.must_be_quick = false;
    MHD_suspend_connection(handle);
    const bool is_accepted =
        jobs_.add([this, request] { answer_file_request(site_, request, options_.rules, cache_); },
                  [handle] { MHD_resume_connection(handle); });
    if (!is_accepted) MHD_resume_connection(handle);
    return MHD_YES;
  }

  static void note(Connection& connection, MHD_Connection* handle, const char* method,
                   const char* version, const FileAnswer& answer) {
    connection.record = {.address = address_of(handle),
                         .method = method,
                         .target = connection.target,
                         .version = version,
                         .status = answer.status,
                         .bytes = has_body(method, answer.status) ? answer.body.bytes() : 0,
                         .referer = header_of(handle, "Referer"),
                         .user_agent = header_of(handle, "User-Agent")};
  }

  static void on_completed(void* self, MHD_Connection* handle, void**,
                           MHD_RequestTerminationCode code) {
    auto& impl = *static_cast<Impl*>(self);
    Connection& connection = connection_of(handle);
    if (!connection.is_begun) return;
    connection.is_begun = false;
    connection.is_prepared = false;
    connection.client->begins_to_wait();
    --impl.under_way_;
    const bool was_answered = connection.record.status != 0;
    if (impl.options_.log == nullptr || !was_answered) return;
    // 499, as nginx: the client left before the end
    if (code != MHD_REQUEST_TERMINATED_COMPLETED_OK) connection.record.status = 499;
    impl.options_.log->write(connection.record);
    connection.record = {};
  }

  const Site& site_;
  HttpDaemonOptions options_;
  GzipCache cache_;
  WaitingClients clients_;
  BackgroundJobs jobs_;
  std::atomic<int> under_way_ = 0;
  MHD_Daemon* daemon_ = nullptr;
  int listening_ = -1;
};

HttpDaemon::HttpDaemon(ListeningSocket& socket, const Site& site, const HttpDaemonOptions& options)
    : impl_(std::make_unique<Impl>(socket, site, options)) {}
HttpDaemon::~HttpDaemon() = default;
void HttpDaemon::finish() { impl_->finish(); }

}  // namespace terrane::viewer

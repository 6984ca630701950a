#include "viewer/server/listening_socket.h"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>

#include "core/errors.h"

namespace terrane::viewer {
namespace {

constexpr int kLargestPort = 65535;
// A browser that opens more at once waits a second for a lost SYN.
constexpr int kBacklog = 511;

using Addresses = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

Addresses addresses_of(const std::string& host, int port) {
  addrinfo hints = {};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  return {found, &::freeaddrinfo};
}

/// \return an open socket, or -1 with errno.
int listen_on(const addrinfo& address) {
  const int descriptor = ::socket(address.ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return -1;
  // not SO_REUSEPORT, which lets two servers take the same port
  const int yes = 1;
  ::setsockopt(descriptor, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (::bind(descriptor, address.ai_addr, address.ai_addrlen) == 0 &&
      ::listen(descriptor, kBacklog) == 0) {
    return descriptor;
  }
  const int reason = errno;
  ::close(descriptor);
  errno = reason;
  return -1;
}

int port_of(int descriptor) {
  sockaddr_storage address = {};
  socklen_t length = sizeof address;
  ::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &length);
  // the port stands at the same place in both families
  return ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

}  // namespace

ListeningSocket::ListeningSocket(const std::string& bind, int port, int tries) {
  if (port < 0 || port > kLargestPort) {
    throw ConfigError(
        fmt::format("port {}: not a port. Give one from 0 to {}", port, kLargestPort));
  }
  const int last = std::min(port + (port == 0 ? 1 : tries) - 1, kLargestPort);
  for (int candidate = port; candidate <= last; ++candidate) {
    errno = 0;
    if (try_port(bind, candidate)) return;
    if (errno != EADDRINUSE) break;
  }
  throw OutputError(fmt::format(
      "{}:{}: cannot serve there ({}). Choose another port with --port or address with --bind",
      bind, last == port ? fmt::to_string(last) : fmt::format("{}-{}", port, last),
      errno == 0 ? "no such address" : std::strerror(errno)));
}

bool ListeningSocket::try_port(const std::string& bind, int port) {
  const Addresses addresses = addresses_of(bind, port);
  for (const addrinfo* at = addresses.get(); at != nullptr; at = at->ai_next) {
    descriptor_ = listen_on(*at);
    if (descriptor_ < 0) continue;
    port_ = port_of(descriptor_);
    is_ipv6_ = at->ai_family == AF_INET6;
    return true;
  }
  return false;
}

ListeningSocket::~ListeningSocket() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

int ListeningSocket::release() {
  const int descriptor = descriptor_;
  descriptor_ = -1;
  return descriptor;
}

}  // namespace terrane::viewer

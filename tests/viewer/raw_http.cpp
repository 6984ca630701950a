#include "tests/viewer/raw_http.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <stdexcept>

namespace terrane::viewer::testing {
namespace {

int connect_to(int port) {
  const int descriptor = ::socket(AF_INET, SOCK_STREAM, 0);
  const timeval patience = {.tv_sec = 20, .tv_usec = 0};
  ::setsockopt(descriptor, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    ::close(descriptor);
    throw std::runtime_error("nobody listens on port " + std::to_string(port));
  }
  return descriptor;
}

std::string exchange(int descriptor, const std::string& request, bool until_closed) {
  std::string answer;
  ::send(descriptor, request.data(), request.size(), MSG_NOSIGNAL);
  char buffer[4096];
  ssize_t got = 0;
  while ((got = ::recv(descriptor, buffer, sizeof buffer, 0)) > 0) {
    answer.append(buffer, static_cast<std::size_t>(got));
    if (!until_closed && answer.find("\r\n") != std::string::npos) break;
  }
  return answer;
}

int status_in(const std::string& status_line) {
  return std::stoi(status_line.substr(status_line.find(' ') + 1));
}

std::pair<std::string, std::string> split_header(const std::string& line) {
  const std::size_t colon = line.find(": ");
  std::string name = line.substr(0, colon);
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return {name, line.substr(colon + 2, line.find('\r') - colon - 2)};
}

}  // namespace

RawAnswer send_raw(int port, const std::string& request) {
  const int descriptor = connect_to(port);
  const std::string received = exchange(descriptor, request, /*until_closed=*/true);
  ::close(descriptor);

  RawAnswer answer;
  const std::size_t head_end = received.find("\r\n\r\n");
  if (head_end == std::string::npos) return answer;
  std::istringstream head(received.substr(0, head_end));
  std::string line;
  std::getline(head, line);
  answer.status = status_in(line);
  while (std::getline(head, line)) answer.headers.insert(split_header(line));
  answer.body = received.substr(head_end + 4);
  return answer;
}

int status_of_raw(int port, const std::string& request) {
  const int descriptor = connect_to(port);
  const std::string received = exchange(descriptor, request, /*until_closed=*/false);
  ::close(descriptor);
  return received.empty() ? 0 : status_in(received);
}

RawAnswer request_raw(int port, const std::string& method, const std::string& target,
                      const std::string& header_lines) {
  return send_raw(port, method + " " + target + " HTTP/1.1\r\nHost: localhost\r\n" + header_lines +
                            "Connection: close\r\n\r\n");
}

}  // namespace terrane::viewer::testing

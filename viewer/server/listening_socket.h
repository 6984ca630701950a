#pragma once

#include <string>

namespace terrane::viewer {

/// A TCP socket that listens; closed when it goes, unless release() was called.
class ListeningSocket {
 public:
  /// Takes a port of an address.
  ///
  /// \param bind   address or host name of this machine; 0.0.0.0 or :: for every network.
  /// \param port   0 to 65535; 0 takes any free one.
  /// \param tries  where the port is taken, so many ports from it on are tried.
  /// \throws ConfigError if the port is out of range; OutputError, one line that says what to do,
  /// if
  ///         none could be taken.
  ListeningSocket(const std::string& bind, int port, int tries);
  ~ListeningSocket();
  ListeningSocket(const ListeningSocket&) = delete;
  ListeningSocket& operator=(const ListeningSocket&) = delete;

  int descriptor() const { return descriptor_; }
  int port() const { return port_; }
  bool is_ipv6() const { return is_ipv6_; }

  /// Hands the descriptor to someone who closes it.
  int release();

 private:
  bool try_port(const std::string& bind, int port);

  int descriptor_ = -1;
  int port_ = 0;
  bool is_ipv6_ = false;
};

}  // namespace terrane::viewer

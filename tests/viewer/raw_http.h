#pragma once

#include <map>
#include <string>

namespace terrane::viewer::testing {

/// What came back over the wire, with nothing mended by a client library.
struct RawAnswer {
  int status = 0;
  std::map<std::string, std::string> headers;  ///< names in lower case
  std::string body;
};

/// Sends bytes to 127.0.0.1 and reads until the server closes, which a request asks for with
/// "Connection: close". Of several answers, those after the first are part of its body.
RawAnswer send_raw(int port, const std::string& request);

/// Sends bytes and reads no more than the status; 0 if the server closes without one.
int status_of_raw(int port, const std::string& request);

/// A request for a target as it is written, with further header lines ("Name: value\r\n").
RawAnswer request_raw(int port, const std::string& method, const std::string& target,
                      const std::string& header_lines = "");

}  // namespace terrane::viewer::testing

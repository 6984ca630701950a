#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <string>

namespace terrane::viewer {

/// What a line of the log says.
struct AccessRecord {
  std::string address;
  std::string method;
  std::string target;
  std::string version;
  int status = 0;
  std::uint64_t bytes = 0;
  std::string referer;
  std::string user_agent;
};

/// A line of the Combined Log Format that log analysers read:
/// `127.0.0.1 - - [26/Nov/2026:12:00:00 +0000] "GET / HTTP/1.1" 200 512 "-" "curl/7.88"`.
///
/// Quotes, backslashes and control characters are escaped as \\xHH.
/// \param time_s  seconds since 1970, UTC.
std::string to_line(const AccessRecord& record, std::int64_t time_s);

/// Appends lines to a file. Thread-safe.
class AccessLog {
 public:
  /// \throws OutputError if the file cannot be opened.
  explicit AccessLog(const std::filesystem::path& file);
  ~AccessLog();
  AccessLog(const AccessLog&) = delete;
  AccessLog& operator=(const AccessLog&) = delete;

  void write(const AccessRecord& record);

 private:
  std::mutex mutex_;
  std::FILE* stream_;
};

}  // namespace terrane::viewer

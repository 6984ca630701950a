#include "viewer/server/access_log.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <ctime>

#include "core/errors.h"

namespace terrane::viewer {
namespace {

std::string quoted(const std::string& text) {
  if (text.empty()) return "\"-\"";
  std::string line = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = byte >= 0x20 && byte != 0x7f && c != '"' && c != '\\';
    line += is_plain ? std::string(1, c) : fmt::format("\\x{:02X}", byte);
  }
  return line + "\"";
}

}  // namespace

std::string to_line(const AccessRecord& record, std::int64_t time_s) {
  return fmt::format("{} - - [{:%d/%b/%Y:%H:%M:%S} +0000] {} {} {} {} {}\n", record.address,
                     fmt::gmtime(static_cast<std::time_t>(time_s)),
                     quoted(record.method + " " + record.target + " " + record.version),
                     record.status, record.bytes, quoted(record.referer),
                     quoted(record.user_agent));
}

AccessLog::AccessLog(const std::filesystem::path& file) : stream_(std::fopen(file.c_str(), "ae")) {
  if (stream_ == nullptr) {
    throw OutputError(fmt::format("{}: the log cannot be opened ({}). Choose another file",
                                  file.string(), std::strerror(errno)));
  }
  // whole lines, as they come: other programs follow the file
  std::setvbuf(stream_, nullptr, _IOLBF, BUFSIZ);
}

AccessLog::~AccessLog() { std::fclose(stream_); }

void AccessLog::write(const AccessRecord& record) {
  const std::string line = to_line(record, std::time(nullptr));
  const std::scoped_lock lock(mutex_);
  std::fwrite(line.data(), 1, line.size(), stream_);
}

}  // namespace terrane::viewer

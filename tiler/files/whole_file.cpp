#include "tiler/files/whole_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

#include "core/errors.h"

namespace terrane::tiler {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, int reason) {
  throw OutputError(
      fmt::format("{}: cannot be written ({}). Free some space, check the folder's "
                  "permissions, or choose another output folder",
                  file.string(), std::strerror(reason)));
}

/// \return 0, or the system's error number.
int write_content(const std::filesystem::path& file, std::string_view content) {
  std::FILE* stream = std::fopen(file.c_str(), "wb");
  if (stream == nullptr) return errno;
  int reason = 0;
  if (std::fwrite(content.data(), 1, content.size(), stream) != content.size()) reason = errno;
  // fclose flushes what is left, and a full disk may show only then
  if (std::fclose(stream) != 0 && reason == 0) reason = errno;
  return reason;
}

}  // namespace

void write_whole_file(const std::filesystem::path& file, std::string_view content) {
  std::error_code error;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), error);
  if (error) fail(file, error.value());
  std::filesystem::path temporary = file;
  temporary += ".tmp";
  if (const int reason = write_content(temporary, content); reason != 0) {
    std::filesystem::remove(temporary, error);
    fail(file, reason);
  }
  std::filesystem::rename(temporary, file, error);
  if (!error) return;
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
  fail(file, error.value());
}

std::string read_whole_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream content;
  content << stream.rdbuf();
  if (!stream) throw InputError(fmt::format("{}: cannot be read", file.string()));
  return std::move(content).str();
}

}  // namespace terrane::tiler

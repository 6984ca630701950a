#include "viewer/server/viewer_files.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

#include "core/errors.h"

namespace terrane::viewer {
namespace {

namespace fs = std::filesystem;

bool holds_already(const fs::path& path, std::string_view content) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return false;
  return std::string(std::istreambuf_iterator<char>(file), {}) == content;
}

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
  throw OutputError(fmt::format("{}: cannot be written ({}). Check the folder and the space left",
                                path.string(), reason));
}

void write_whole(const fs::path& path, std::string_view content) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  if (error) fail(path.parent_path(), error.message());

  const fs::path temporary = path.string() + ".part";
  errno = 0;
  std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  if (!file) {
    const std::string reason = std::strerror(errno);
    fs::remove(temporary, error);
    fail(path, reason);
  }
  fs::rename(temporary, path, error);
  if (error) {
    const std::string reason = error.message();
    fs::remove(temporary, error);
    fail(path, reason);
  }
}

void write_all(std::span<const ViewerFile> files, const fs::path& out) {
  for (const ViewerFile& file : files) {
    const fs::path path = out / file.path;
    if (!holds_already(path, file.content)) write_whole(path, file.content);
  }
}

}  // namespace

void write_viewer(const fs::path& out) { write_all(viewer_files(), out); }

void write_volume_page(const fs::path& out) { write_all(volume_page_files(), out); }

}  // namespace terrane::viewer

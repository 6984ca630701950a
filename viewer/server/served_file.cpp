#include "viewer/server/served_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <system_error>

namespace terrane::viewer {
namespace {

namespace fs = std::filesystem;

// Backslashes are folders to some clients, and a NUL ends a path early.
bool has_forbidden_character(std::string_view path) {
  return std::any_of(path.begin(), path.end(),
                     [](unsigned char c) { return c < 0x20 || c == 0x7f || c == '\\'; });
}

// Hidden files and, since they start with a dot too, "." and "..".
bool is_hidden(const fs::path& name) { return name.native().starts_with('.'); }

std::optional<fs::path> relative_path(std::string_view url_path) {
  if (!url_path.starts_with('/') || has_forbidden_character(url_path)) return std::nullopt;
  fs::path path(url_path.substr(1));
  if (path.is_absolute()) return std::nullopt;
  if (!path.has_filename()) path /= "index.html";
  if (std::any_of(path.begin(), path.end(), is_hidden)) return std::nullopt;
  return path;
}

// Where symbolic links lead in the end, if that is still inside and visible.
std::optional<fs::path> canonical_inside(const fs::path& root, const fs::path& relative) {
  std::error_code error;
  const fs::path path = fs::canonical(root / relative, error);
  if (error) return std::nullopt;
  const auto [in_root, in_path] = std::mismatch(root.begin(), root.end(), path.begin(), path.end());
  if (in_root != root.end() || std::any_of(in_path, path.end(), is_hidden)) return std::nullopt;
  return path;
}

std::shared_ptr<const OpenFile> open_regular_file(const fs::path& path) {
  // O_NONBLOCK: opening a named pipe must not wait for a writer
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor < 0) return nullptr;
  struct stat status = {};
  if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor);
    return nullptr;
  }
  const std::int64_t modified_ns =
      std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec;
  return std::make_shared<const OpenFile>(descriptor, static_cast<std::uint64_t>(status.st_size),
                                          modified_ns);
}

}  // namespace

OpenFile::~OpenFile() { ::close(descriptor_); }

std::string OpenFile::read(std::uint64_t offset, std::uint64_t length) const {
  std::string content(length, '\0');
  std::size_t filled = 0;
  while (filled < length) {
    const ssize_t got = ::pread(descriptor_, content.data() + filled, length - filled,
                                static_cast<off_t>(offset + filled));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    filled += static_cast<std::size_t>(got);
  }
  content.resize(filled);
  return content;
}

std::optional<ServedFile> open_served_file(const fs::path& root, std::string_view url_path) {
  const auto relative = relative_path(url_path);
  if (!relative) return std::nullopt;
  const auto path = canonical_inside(root, *relative);
  if (!path) return std::nullopt;
  auto content = open_regular_file(*path);
  if (!content) return std::nullopt;
  return ServedFile{*path, std::move(content)};
}

}  // namespace terrane::viewer

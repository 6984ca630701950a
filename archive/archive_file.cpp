#include "archive/archive_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/errors.h"

namespace terrane::archive {

ArchiveFile::ArchiveFile(const std::filesystem::path& path) : path_(path) {
  // O_NONBLOCK: opening a named pipe must not wait for a writer
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0) {
    throw InputError(fmt::format("{}: cannot be opened ({}). Check the name", path.string(),
                                 std::strerror(errno)));
  }
  struct stat status = {};
  if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor_);
    throw InputError(fmt::format("{}: is no file. Give an archive", path.string()));
  }
  bytes_ = static_cast<std::uint64_t>(status.st_size);
  modified_ns_ = std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec;
}

ArchiveFile::~ArchiveFile() { ::close(descriptor_); }

std::string ArchiveFile::read(std::uint64_t offset, std::uint64_t length) const {
  if (!holds(offset, length)) {
    fail(fmt::format("{} bytes are wanted at {}, it has {}", length, offset, bytes_));
  }
  std::string content(length, '\0');
  std::size_t filled = 0;
  while (filled < length) {
    const ssize_t got = ::pread(descriptor_, content.data() + filled, length - filled,
                                static_cast<off_t>(offset + filled));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) fail("it was cut off while it was read");
    filled += static_cast<std::size_t>(got);
  }
  return content;
}

void ArchiveFile::fail(const std::string& what) const {
  throw InputError(fmt::format("{}: damaged archive ({}). Copy it again, or pack it again",
                               path_.string(), what));
}

}  // namespace terrane::archive

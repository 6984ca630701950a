#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace terrane::archive {

/// An archive, open for reading at any place. Replacing the file does not change what is read.
///
/// Thread-safe once constructed.
class ArchiveFile {
 public:
  /// \throws InputError if the file cannot be opened or is no regular file.
  explicit ArchiveFile(const std::filesystem::path& path);
  ~ArchiveFile();
  ArchiveFile(const ArchiveFile&) = delete;
  ArchiveFile& operator=(const ArchiveFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t bytes() const { return bytes_; }
  std::int64_t modified_ns() const { return modified_ns_; }
  int descriptor() const { return descriptor_; }

  /// True if bytes [offset, offset + length) are there.
  bool holds(std::uint64_t offset, std::uint64_t length) const {
    return offset <= bytes_ && length <= bytes_ - offset;
  }

  /// Reads bytes [offset, offset + length).
  /// \throws InputError if they are not there.
  std::string read(std::uint64_t offset, std::uint64_t length) const;

  /// \throws InputError always: where, what is wrong, what to do.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t bytes_ = 0;
  std::int64_t modified_ns_ = 0;
};

}  // namespace terrane::archive

#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string_view>

namespace terrane::archive {

/// A file that is there whole or not at all: written under a temporary name, renamed by finish().
/// Without finish() nothing is left behind.
class NewFile {
 public:
  /// \throws OutputError if it cannot be made.
  explicit NewFile(const std::filesystem::path& path);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// \throws OutputError with the system's reason.
  void write(std::string_view bytes);
  std::uint64_t position() const { return position_; }

  /// \throws OutputError with the system's reason.
  void finish();

 private:
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  std::FILE* stream_ = nullptr;
  std::uint64_t position_ = 0;
};

}  // namespace terrane::archive

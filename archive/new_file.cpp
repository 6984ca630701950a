#include "archive/new_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include "core/errors.h"

namespace terrane::archive {

NewFile::NewFile(const std::filesystem::path& path) : path_(path), temporary_(path) {
  temporary_ += ".tmp";
  std::error_code error;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
  stream_ = std::fopen(temporary_.c_str(), "wb");
  if (stream_ == nullptr) fail();
}

NewFile::~NewFile() {
  if (stream_ == nullptr) return;
  std::fclose(stream_);
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void NewFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_) != bytes.size()) fail();
  position_ += bytes.size();
}

void NewFile::finish() {
  // a full disk may show only when what is left is flushed
  if (std::fflush(stream_) != 0) fail();
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail();
  std::fclose(stream_);
  stream_ = nullptr;
}

void NewFile::fail() const {
  throw OutputError(
      fmt::format("{}: cannot be written ({}). Free some space, check the folder's permissions, or "
                  "choose another file",
                  path_.string(), std::strerror(errno)));
}

}  // namespace terrane::archive

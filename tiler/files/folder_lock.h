#pragma once

#include <filesystem>

namespace terrane::tiler {

/// Keeps other runs out of a folder while it lives. Nothing is written: the folder itself is
/// locked, and free again when the process ends, however it does.
///
/// Does nothing where the file system has no such locks.
class FolderLock {
 public:
  /// \throws OutputError if another run, or another FolderLock, has it.
  explicit FolderLock(const std::filesystem::path& folder);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

 private:
  int descriptor_;
};

}  // namespace terrane::tiler

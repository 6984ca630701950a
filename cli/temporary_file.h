#pragma once

#include <filesystem>

namespace terrane::cli {

/// A file that goes with its owner.
struct TemporaryFile {
  std::filesystem::path path;

  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

}  // namespace terrane::cli

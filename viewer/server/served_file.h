#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace terrane::viewer {

/// A regular file, open for reading. Replacing the file by another does not change what is read.
class OpenFile {
 public:
  /// \param descriptor  an open file descriptor, owned from now on.
  OpenFile(int descriptor, std::uint64_t bytes, std::int64_t modified_ns)
      : descriptor_(descriptor), bytes_(bytes), modified_ns_(modified_ns) {}
  ~OpenFile();
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  std::uint64_t bytes() const { return bytes_; }
  std::int64_t modified_ns() const { return modified_ns_; }
  int descriptor() const { return descriptor_; }

  /// Reads at most `length` bytes from `offset`; an empty string at the end or on failure.
  /// Thread-safe.
  std::string read(std::uint64_t offset, std::uint64_t length) const;

 private:
  int descriptor_;
  std::uint64_t bytes_;
  std::int64_t modified_ns_;
};

/// A file that a request may see.
struct ServedFile {
  std::filesystem::path path;  ///< canonical
  std::shared_ptr<const OpenFile> content;
};

/// Opens the file that a URL names; nothing for whatever must not be seen.
///
/// Guarantees: the opened file is regular and its canonical path lies in `root`, with no part that
/// starts with a dot. `/` and `/folder/` name the folder's index.html.
///
/// \param root      canonical path of the served folder.
/// \param url_path  path of the URL, percent-decoded once, without query.
std::optional<ServedFile> open_served_file(const std::filesystem::path& root,
                                           std::string_view url_path);

}  // namespace terrane::viewer

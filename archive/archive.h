#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "archive/archive_file.h"

namespace terrane::archive {

/// How an archive has compressed a file.
enum class Coding { kNone, kGzip, kDeflate };

/// Bytes [offset, offset + length) of an archive, which hold one file.
struct StoredBytes {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  Coding coding = Coding::kNone;
  std::uint64_t most_plain_bytes = std::uint64_t{4} << 30;  ///< more than that is damage
};

/// A file is either bytes of the archive, or content that had to be taken out of something else.
using Content = std::variant<StoredBytes, std::string>;

/// Facts for people.
struct ArchiveFacts {
  std::string format;            ///< "PMTiles 3", "3tz"
  std::uint64_t files = 0;       ///< names
  std::uint64_t contents = 0;    ///< different contents that are stored
  std::uint64_t tile_bytes = 0;  ///< of the tiles, as stored
  std::string tiles;  ///< of a PMTiles: "65 of tiles/{l}/{x}/{y}.glb, zooms 0 to 3, clustered"
};

/// Files by name, as they lay in the folder that was packed: "tiles/0/3/4.glb".
///
/// Guarantees: names are relative, in UTF-8, and have no part that is empty or starts with a dot;
/// all places lie inside the archive. Thread-safe.
class Archive {
 public:
  virtual ~Archive() = default;

  /// Where a file is; nothing if there is none of this name.
  /// \throws InputError if the archive is damaged there.
  virtual std::optional<Content> find(std::string_view name) const = 0;

  /// Calls \p visit with every name once, in a fixed order.
  virtual void for_each_name(const std::function<void(const std::string&)>& visit) const = 0;

  virtual ArchiveFacts facts() const = 0;
  virtual const ArchiveFile& file() const = 0;

  /// The content of a file as it was packed; nothing if there is none of this name.
  /// \throws InputError if the archive is damaged there.
  virtual std::optional<std::string> read(std::string_view name) const;
};

/// True if the name ends with .pmtiles or .3tz, in small or capital letters.
bool is_archive_name(const std::filesystem::path& path);

/// Opens a .pmtiles or a .3tz, by its first bytes.
///
/// \throws InputError if it is none, is damaged, or is a PMTiles that terrane did not pack.
std::unique_ptr<Archive> open_archive(const std::filesystem::path& path);

/// True for names that an archive may hold (see Archive).
bool is_safe_name(std::string_view name);

}  // namespace terrane::archive

#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "archive/archive_file.h"

namespace terrane::archive {

/// Where tiles are, or, with a run length of 0, the directory of the tiles from here on.
struct DirectoryEntry {
  std::uint64_t tile_id = 0;
  std::uint64_t offset = 0;  ///< from the start of the tile data, or of the leaf directories
  std::uint32_t length = 0;
  std::uint32_t run_length = 0;  ///< tiles, one after the other, that share these bytes

  bool operator==(const DirectoryEntry&) const = default;
};

/// Serializes a directory, not yet compressed.
/// \pre entries are sorted by tile_id.
/// \par Source
/// PMTiles version 3 specification, chapter 4.2.
std::string encode_directory(std::span<const DirectoryEntry> entries);

/// Undoes encode_directory().
///
/// Guarantees: ids are strictly ascending; runs do not overlap the next entry; lengths are above 0;
/// offset + length fits 63 bits.
/// \throws InputError about \p file if the bytes are no directory.
std::vector<DirectoryEntry> decode_directory(std::string_view bytes, const ArchiveFile& file);

}  // namespace terrane::archive

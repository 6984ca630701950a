#pragma once

#include <cstdint>
#include <string>

#include "archive/archive_file.h"

namespace terrane::archive {

/// The header of a PMTiles archive, its first 127 bytes.
///
/// \par Source
/// PMTiles version 3 specification, chapter 3.
struct PmtilesHeader {
  struct Section {
    std::uint64_t offset = 0;
    std::uint64_t length = 0;
  };
  enum Compression : std::uint8_t { kUnknown = 0, kNone = 1, kGzip = 2 };

  static constexpr std::uint64_t kBytes = 127;
  /// Header and root directory end here, so that one request gets both.
  static constexpr std::uint64_t kFirstRequestBytes = 16384;

  Section root, metadata, leaves, tiles;
  std::uint64_t addressed_tiles = 0;  ///< with those of runs
  std::uint64_t tile_entries = 0;
  std::uint64_t tile_contents = 0;  ///< different ones
  bool is_clustered = false;
  std::uint8_t internal_compression = kGzip;
  std::uint8_t tile_compression = kNone;
  std::uint8_t tile_type = 0;  ///< 0 other, 2 PNG, 3 JPEG, 4 WebP
  std::uint8_t min_zoom = 0;
  std::uint8_t max_zoom = 0;
  std::int32_t west_e7 = 0;  ///< degrees times 10,000,000
  std::int32_t south_e7 = 0;
  std::int32_t east_e7 = 0;
  std::int32_t north_e7 = 0;
  std::uint8_t centre_zoom = 0;
  std::int32_t centre_longitude_e7 = 0;
  std::int32_t centre_latitude_e7 = 0;
};

std::string encode_header(const PmtilesHeader& header);

/// Reads and checks the header of an archive.
///
/// Guarantees: the sections lie inside the file.
/// \throws InputError if it is no PMTiles 3, or damaged.
PmtilesHeader read_header(const ArchiveFile& file);

}  // namespace terrane::archive

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace terrane {

/// Compresses; the same content gives the same bytes (no time, no name).
/// \param level  of zlib, from 1 (fast) to 9 (small).
std::string gzip(std::string_view content, int level = 9);
/// The same without a header and a checksum, as small as zlib can.
std::string deflate_raw(std::string_view content);

/// Undoes gzip() or deflate_raw(). Nothing if the bytes are damaged, or would become more than
/// \p most_bytes.
std::optional<std::string> gunzip(std::string_view bytes, std::uint64_t most_bytes);
std::optional<std::string> inflate_raw(std::string_view bytes, std::uint64_t most_bytes);

/// True if the bytes begin as a gzip file does.
bool looks_gzipped(std::string_view bytes);

/// The checksum of gzip and ZIP.
std::uint32_t crc32_of(std::string_view content);

}  // namespace terrane

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace terrane::archive {

/// Compresses as hard as zlib can; the same content gives the same bytes (no time, no name).
std::string gzip(std::string_view content);
std::string deflate_raw(std::string_view content);

/// Undoes gzip() or deflate_raw(). Nothing if the bytes are damaged, or would become more than
/// \p most_bytes.
std::optional<std::string> gunzip(std::string_view bytes, std::uint64_t most_bytes);
std::optional<std::string> inflate_raw(std::string_view bytes, std::uint64_t most_bytes);

/// True if the bytes begin as a gzip file does.
bool looks_gzipped(std::string_view bytes);

/// The checksum of gzip and ZIP.
std::uint32_t crc32_of(std::string_view content);

}  // namespace terrane::archive

#include "core/deflate/deflate.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <limits>
#include <new>

namespace terrane {
namespace {

constexpr int kGzipWindow = MAX_WBITS + 16;  // zlib's ways to ask for the gzip format
constexpr int kRawWindow = -MAX_WBITS;       // and for none
constexpr std::size_t kMostAtOnce = std::numeric_limits<uInt>::max();

// zlib's interface predates const; it does not write to its input
Bytef* input_of(const char* bytes) { return reinterpret_cast<Bytef*>(const_cast<char*>(bytes)); }

std::string compress(std::string_view content, int window, int level) {
  z_stream stream = {};
  if (deflateInit2(&stream, level, Z_DEFLATED, window, 8, Z_DEFAULT_STRATEGY) != Z_OK) {
    throw std::bad_alloc();
  }
  std::string compressed;
  std::array<char, 1 << 16> piece;
  int status = Z_OK;
  do {
    if (stream.avail_in == 0) {
      const std::size_t next = std::min(content.size(), kMostAtOnce);
      stream.next_in = input_of(content.data());
      stream.avail_in = static_cast<uInt>(next);
      content.remove_prefix(next);
    }
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = piece.size();
    status = deflate(&stream, content.empty() ? Z_FINISH : Z_NO_FLUSH);
    compressed.append(piece.data(), piece.size() - stream.avail_out);
  } while (status != Z_STREAM_END);
  deflateEnd(&stream);
  return compressed;
}

std::optional<std::string> decompress(std::string_view bytes, std::uint64_t most_bytes,
                                      int window) {
  z_stream stream = {};
  if (inflateInit2(&stream, window) != Z_OK) throw std::bad_alloc();
  std::string plain;
  std::array<char, 1 << 16> piece;
  int status = Z_OK;
  while (status == Z_OK && plain.size() <= most_bytes) {
    if (stream.avail_in == 0) {
      const std::size_t next = std::min(bytes.size(), kMostAtOnce);
      stream.next_in = input_of(bytes.data());
      stream.avail_in = static_cast<uInt>(next);
      bytes.remove_prefix(next);
    }
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = piece.size();
    status = inflate(&stream, Z_NO_FLUSH);  // Z_BUF_ERROR where the input ends too early
    plain.append(piece.data(), piece.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  if (status != Z_STREAM_END || plain.size() > most_bytes) return std::nullopt;
  return plain;
}

}  // namespace

std::string gzip(std::string_view content, int level) {
  return compress(content, kGzipWindow, level);
}

std::string deflate_raw(std::string_view content) {
  return compress(content, kRawWindow, Z_BEST_COMPRESSION);
}

std::optional<std::string> gunzip(std::string_view bytes, std::uint64_t most_bytes) {
  return decompress(bytes, most_bytes, kGzipWindow);
}

std::optional<std::string> inflate_raw(std::string_view bytes, std::uint64_t most_bytes) {
  return decompress(bytes, most_bytes, kRawWindow);
}

bool looks_gzipped(std::string_view bytes) { return bytes.starts_with("\x1f\x8b\x08"); }

std::uint32_t crc32_of(std::string_view content) {
  return static_cast<std::uint32_t>(crc32_z(0, input_of(content.data()), content.size()));
}

}  // namespace terrane

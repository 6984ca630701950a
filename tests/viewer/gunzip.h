#pragma once

#include <zlib.h>

#include <string>
#include <string_view>

namespace terrane::viewer::testing {

/// Unpacks gzip data; a message instead of the content if it is not `bytes` long in the end.
inline std::string gunzip(std::string_view compressed, std::size_t bytes) {
  z_stream stream = {};
  inflateInit2(&stream, MAX_WBITS + 16);
  std::string content(bytes + 1, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(compressed.data()));
  stream.avail_in = static_cast<uInt>(compressed.size());
  stream.next_out = reinterpret_cast<Bytef*>(content.data());
  stream.avail_out = static_cast<uInt>(content.size());
  const int status = inflate(&stream, Z_FINISH);
  inflateEnd(&stream);
  content.resize(stream.total_out);
  return status == Z_STREAM_END ? content : "not the gzip data that was expected";
}

}  // namespace terrane::viewer::testing

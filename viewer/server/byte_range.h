#pragma once

#include <cstdint>
#include <string_view>
#include <variant>

namespace terrane::viewer {

/// The request wants all of the file, or something that a server may answer with all of it.
struct WholeFile {};

/// The request wants bytes that the file does not have (status 416).
struct NoSuchBytes {};

/// Bytes [offset, offset + length) of a file.
struct ByteRange {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
};

/// Reads the value of a Range header.
///
/// Several ranges, other units than bytes and malformed values mean the whole file, which RFC 9110
/// allows and clients must expect.
///
/// \param header  value of the header, empty if there is none.
/// \param bytes   size of the file.
/// \par Source
/// RFC 9110, section 14.1.2.
std::variant<WholeFile, NoSuchBytes, ByteRange> parse_byte_range(std::string_view header,
                                                                 std::uint64_t bytes);

}  // namespace terrane::viewer

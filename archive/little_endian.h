#pragma once

#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>

namespace terrane::archive {

/// Appends a whole number, its lowest byte first.
template <std::integral T>
void append_little_endian(std::string& bytes, T value) {
  auto rest = static_cast<std::make_unsigned_t<T>>(value);
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    bytes.push_back(static_cast<char>(rest & 0xff));
    if constexpr (sizeof(T) > 1) rest = static_cast<decltype(rest)>(rest >> 8);
  }
}

/// Reads a whole number, its lowest byte first.
/// \pre offset + sizeof(T) <= bytes.size()
template <std::integral T>
T read_little_endian(std::string_view bytes, std::size_t offset) {
  std::make_unsigned_t<T> value = 0;
  for (std::size_t i = sizeof(T); i-- > 0;) {
    if constexpr (sizeof(T) > 1) value = static_cast<decltype(value)>(value << 8);
    value = static_cast<decltype(value)>(value | static_cast<unsigned char>(bytes[offset + i]));
  }
  return static_cast<T>(value);
}

}  // namespace terrane::archive

#pragma once

// The libc++ of Debian 12's emscripten has <bit> without std::bit_cast; the compiler has it.
#include <bit>

#ifndef __cpp_lib_bit_cast
namespace std {

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

}  // namespace std
#endif

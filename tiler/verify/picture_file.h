#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace terrane::verify {

/// A square picture: red, green and blue, row by row from the top.
struct Picture {
  int side_px = 0;
  std::vector<std::uint8_t> rgb;
  std::int64_t bytes = 0;  ///< on disk
};

/// Reads a PNG of 8 bits and three channels, as terrain is stored.
/// \throws InputError that names the file if it is missing, damaged, or another kind of picture.
/// \par Source
/// PNG specification, 2nd edition (ISO/IEC 15948).
Picture read_png(const std::filesystem::path& file);

}  // namespace terrane::verify

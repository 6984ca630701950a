#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace terrane::ingest {

/// A square picture of 8-bit red, green and blue, row by row, as a file that loses nothing.
///
/// Thread-safe; the same pixels give the same bytes.
/// \param rgb      3 * side_px * side_px values.
/// \param is_webp  lossless WebP, else PNG.
/// \throws InputError if GDAL was built without the format.
std::string encode_lossless(std::span<const std::uint8_t> rgb, int side_px, bool is_webp);

}  // namespace terrane::ingest

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace terrane::tiler {

/// How a height stands in the three bytes of a pixel.
enum class HeightEncoding {
  kTerrarium,   ///< red * 256 + green + blue / 256 - 32768 metres: steps of 1/256 m
  kTerrainRgb,  ///< -10000 + (red * 65536 + green * 256 + blue) / 10 metres: steps of 0.1 m
};

/// "terrarium" or "terrain-rgb"; nothing for another word.
std::optional<HeightEncoding> height_encoding_of(std::string_view word);
/// What MapLibre calls it: "terrarium" or "mapbox".
std::string_view maplibre_name(HeightEncoding encoding);

/// The heights that an encoding has, both ends included.
struct HeightRange {
  double low_m = 0, high_m = 0;
};
HeightRange range_of(HeightEncoding encoding);

/// Red, green and blue of each height, rounded to the nearest step.
///
/// \param heights_m  in range_of(encoding); NaN: no data.
/// \param fill_m     what stands for no data.
std::vector<std::uint8_t> colours_of(std::span<const float> heights_m, HeightEncoding encoding,
                                     double fill_m);

}  // namespace terrane::tiler

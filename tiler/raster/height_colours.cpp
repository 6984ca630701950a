#include "tiler/raster/height_colours.h"

#include <algorithm>
#include <cmath>

namespace terrane::tiler {
namespace {

/// A height is lowest_m + n / steps_per_m, n a number of 24 bits.
struct Steps24 {
  double lowest_m = 0, steps_per_m = 1;
};

constexpr std::uint32_t kMost = 0xffffff;

Steps24 steps_of(HeightEncoding encoding) {
  return encoding == HeightEncoding::kTerrarium ? Steps24{-32768, 256} : Steps24{-10000, 10};
}

}  // namespace

std::optional<HeightEncoding> height_encoding_of(std::string_view word) {
  if (word == "terrarium") return HeightEncoding::kTerrarium;
  if (word == "terrain-rgb") return HeightEncoding::kTerrainRgb;
  return std::nullopt;
}

std::string_view maplibre_name(HeightEncoding encoding) {
  return encoding == HeightEncoding::kTerrarium ? "terrarium" : "mapbox";
}

HeightRange range_of(HeightEncoding encoding) {
  const auto [lowest_m, steps_per_m] = steps_of(encoding);
  return {lowest_m, lowest_m + kMost / steps_per_m};
}

std::vector<std::uint8_t> colours_of(std::span<const float> heights_m, HeightEncoding encoding,
                                     double fill_m) {
  const auto [lowest_m, steps_per_m] = steps_of(encoding);
  std::vector<std::uint8_t> rgb;
  rgb.reserve(3 * heights_m.size());
  for (const float height_m : heights_m) {
    const double over_m = (std::isnan(height_m) ? fill_m : double{height_m}) - lowest_m;
    const double steps = std::clamp(std::round(over_m * steps_per_m), 0.0, double{kMost});
    const auto number = static_cast<std::uint32_t>(steps);
    for (const int shift : {16, 8, 0}) rgb.push_back((number >> shift) & 0xff);
  }
  return rgb;
}

}  // namespace terrane::tiler

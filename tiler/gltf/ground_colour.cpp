#include "tiler/gltf/ground_colour.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace terrane::tiler {
namespace {

/// A colour at a place between 0 and 1, linear light from 0 to 1.
struct Stop {
  double at;
  Eigen::Vector3d colour;
};

const Stop kByHeight[] = {
    {0.0, {0.13, 0.24, 0.09}}, {0.3, {0.35, 0.42, 0.16}}, {0.55, {0.42, 0.30, 0.15}},
    {0.8, {0.30, 0.24, 0.20}}, {1.0, {0.92, 0.92, 0.92}},
};

/// From flat to 60 degrees.
const Stop kBySlope[] = {
    {0.0, {0.72, 0.70, 0.60}},
    {0.4, {0.62, 0.42, 0.16}},
    {0.75, {0.38, 0.10, 0.04}},
    {1.0, {0.12, 0.02, 0.02}},
};

Colour4 between(std::span<const Stop> stops, double at) {
  std::size_t next = 1;
  while (next + 1 < stops.size() && stops[next].at < at) ++next;
  const Stop& low = stops[next - 1];
  const Stop& high = stops[next];
  const double share = std::clamp((at - low.at) / (high.at - low.at), 0.0, 1.0);
  const Eigen::Vector3d colour = 255 * (low.colour + share * (high.colour - low.colour));
  const auto byte = [](double value) { return static_cast<std::uint8_t>(std::lround(value)); };
  return {byte(colour.x()), byte(colour.y()), byte(colour.z()), 255};
}

}  // namespace

Colour4 colour_of(Colour colour, const Ground& ground, const HeightStatistics& heights) {
  if (colour == Colour::kSlope) {
    // of the angle's half, which goes up evenly enough and needs no inverse cosine
    constexpr double kSteepest = 0.5;  // sine of half of 60 degrees
    const double half_sine = std::sqrt(std::max(0.0, (1.0 - ground.slope) / 2));
    return between(kBySlope, half_sine / kSteepest);
  }
  const double range_m = std::max(1e-3, heights.max_height_m - heights.min_height_m);
  return between(kByHeight, (ground.height_m - heights.min_height_m) / range_m);
}

}  // namespace terrane::tiler

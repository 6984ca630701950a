#include "ingest/synthetic_terrain.h"

#include <algorithm>
#include <cmath>

#include "ingest/fingerprint.h"

namespace terrane::ingest {
namespace {

constexpr double kRimRadius = 0.5;
constexpr double kLakeHeight_m = 800;

double smooth_step(double t) { return t * t * (3 - 2 * t); }

// 1 at distance 0, 0 from distance 1 on, smooth at both
double bump(double distance) {
  const double t = 1 - std::min(distance * distance, 1.0);
  return t * t;
}

// Random values on the integer lattice, blended between; from -1 to 1.
double value_noise(double x, double y, std::uint64_t seed, std::uint64_t octave) {
  const double column = std::floor(x);
  const double row = std::floor(y);
  const auto i = static_cast<std::int64_t>(column);
  const auto j = static_cast<std::int64_t>(row);
  const double u = smooth_step(x - column);
  const double v = smooth_step(y - row);
  const double upper =
      hashed_fraction(seed, octave, i, j) * (1 - u) + hashed_fraction(seed, octave, i + 1, j) * u;
  const double lower = hashed_fraction(seed, octave, i, j + 1) * (1 - u) +
                       hashed_fraction(seed, octave, i + 1, j + 1) * u;
  return 2 * (upper * (1 - v) + lower * v) - 1;
}

double fractal_hills_m(double x, double y, std::uint64_t seed) {
  double height_m = 0;
  double frequency = 3;
  double amplitude_m = 120;
  for (std::uint64_t octave = 0; octave < 7; ++octave) {
    height_m += amplitude_m * value_noise(x * frequency, y * frequency, seed, octave);
    frequency *= 2;
    amplitude_m *= 0.5;
  }
  return height_m;
}

// steep to the lake, gentle to the outside, and a floor below the lake's level
double ring_m(double radius) {
  if (radius >= kRimRadius) return 900 * bump((radius - kRimRadius) / 0.45);
  return 1100 * bump((kRimRadius - radius) / 0.22) - 200;
}

double island_m(double x, double y) {
  const double dx = x - 0.12;
  const double dy = y + 0.08;
  return 750 * bump(std::sqrt(dx * dx + dy * dy) / 0.14);
}

}  // namespace

double hashed_fraction(std::uint64_t seed, std::uint64_t stream, std::int64_t i, std::int64_t j) {
  Fingerprint key;
  key.add(seed);
  key.add(stream);
  key.add(static_cast<std::uint64_t>(i));
  key.add(static_cast<std::uint64_t>(j));
  return static_cast<double>(key.value() >> 11) * 0x1p-53;
}

double caldera_height_m(double x, double y, std::uint64_t seed) {
  const double radius = std::sqrt(x * x + y * y);
  const double ground_m = 600 + fractal_hills_m(x, y, seed) + ring_m(radius) + island_m(x, y);
  // the rim is higher than the lake all around, so the lake ends at a shore
  return radius < kRimRadius ? std::max(ground_m, kLakeHeight_m) : ground_m;
}

}  // namespace terrane::ingest

#include "tiler/gltf/glb_values.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace terrane::tiler {
namespace {

template <class T>
void append(std::string& bytes, const T& value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

/// Elements of some integer type, padded to whole words.
template <class T>
GlbValues integers(Component component, int components, bool is_normalized) {
  return {.component = component,
          .components = components,
          .is_normalized = is_normalized,
          .stride = (components * sizeof(T) + 3) / 4 * 4};
}

template <class T, std::size_t kCount>
void add_integers(GlbValues& values, const std::array<T, kCount>& element) {
  for (const T value : element) append(values.bytes, value);
  values.bytes.resize(++values.count * values.stride);
}

/// Floats that are whole multiples of 2^exponent, by component.
template <std::size_t kCount>
GlbValues floats(const std::vector<std::array<std::int32_t, kCount>>& multiples,
                 const std::array<int, kCount>& exponents) {
  GlbValues values{.components = kCount,
                   .count = multiples.size(),
                   .stride = 4 * kCount,
                   .filter = Filter::kExponential};
  for (const auto& element : multiples) {
    for (std::size_t k = 0; k < kCount; ++k) {
      constexpr std::uint32_t kMantissa = 0xffffff;
      const auto exponent = static_cast<std::uint32_t>(exponents[k]) << 24;
      append(values.filtered, exponent | (static_cast<std::uint32_t>(element[k]) & kMantissa));
      append(values.bytes, std::ldexp(static_cast<float>(element[k]), exponents[k]));
    }
  }
  std::copy(exponents.begin(), exponents.end(), values.exponent.begin());
  return values;
}

bool fits_16_bits(const std::vector<Steps>& values) {
  return std::ranges::all_of(values, [](const Steps& v) {
    return std::ranges::all_of(v, [](std::int32_t c) { return std::int16_t(c) == c; });
  });
}

template <class T>
T rounded(double value) {
  return static_cast<T>(std::lround(value));
}

}  // namespace

GlbValues values_of_steps(const std::vector<Steps>& steps, Positions positions,
                          const std::array<double, 3>& step_m) {
  GlbValues values;
  std::array<int, 3> exponents = {};
  if (positions == Positions::kMetres) {
    for (std::size_t axis = 0; axis < 3; ++axis) exponents[axis] = std::ilogb(step_m[axis]);
  }
  if (positions == Positions::kLattice && fits_16_bits(steps)) {
    values = integers<std::int16_t>(Component::kShort, 3, false);
    for (const auto& [x, y, z] : steps) {
      add_integers(values, std::array{static_cast<std::int16_t>(x), static_cast<std::int16_t>(y),
                                      static_cast<std::int16_t>(z)});
    }
  } else {
    values = floats(steps, exponents);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] =
        std::ranges::minmax(steps, {}, [axis](const Steps& s) { return s[axis]; });
    values.low.push_back(std::ldexp(low[axis], exponents[axis]));
    values.high.push_back(std::ldexp(high[axis], exponents[axis]));
  }
  return values;
}

GlbValues values_of_normals(const std::vector<Eigen::Vector3f>& normals, bool as_floats) {
  if (as_floats) {
    // as exact as gltf-validator wants a unit vector to be (0.0005)
    constexpr int kExponent = -14;
    std::vector<Steps> multiples;
    for (const Eigen::Vector3f& n : normals) {
      const auto multiple = [](float v) {
        return rounded<std::int32_t>(std::ldexp(v, -kExponent));
      };
      multiples.push_back({multiple(n.x()), multiple(n.y()), multiple(n.z())});
    }
    return floats(multiples, {kExponent, kExponent, kExponent});
  }
  GlbValues values = integers<std::int8_t>(Component::kByte, 3, true);
  values.filter = Filter::kOctahedral;
  for (const Eigen::Vector3f& n : normals) {
    constexpr int kBits = 8;
    const std::array<float, 4> vector{n.x(), n.y(), n.z(), 0};
    char word[4];
    meshopt_encodeFilterOct(word, 1, sizeof(word), kBits, vector.data());
    values.filtered.append(word, sizeof(word));
    const Eigen::Vector3d scaled = n.cast<double>() * 127;
    add_integers(values,
                 std::array{rounded<std::int8_t>(scaled.x()), rounded<std::int8_t>(scaled.y()),
                            rounded<std::int8_t>(scaled.z())});
  }
  return values;
}

GlbValues values_of_places(const std::vector<Eigen::Vector2f>& places, bool as_floats) {
  if (as_floats) {
    constexpr int kExponent = -16;
    std::vector<std::array<std::int32_t, 2>> multiples;
    for (const Eigen::Vector2f& p : places) {
      multiples.push_back({rounded<std::int32_t>(std::ldexp(p.x(), -kExponent)),
                           rounded<std::int32_t>(std::ldexp(p.y(), -kExponent))});
    }
    return floats(multiples, {kExponent, kExponent});
  }
  GlbValues values = integers<std::uint16_t>(Component::kUnsignedShort, 2, true);
  for (const Eigen::Vector2f& p : places) {
    add_integers(values, std::array{rounded<std::uint16_t>(p.x() * 65535.0),
                                    rounded<std::uint16_t>(p.y() * 65535.0)});
  }
  return values;
}

GlbValues values_of_colours(const std::vector<Colour4>& colours) {
  GlbValues values = integers<std::uint8_t>(Component::kUnsignedByte, 4, true);
  for (const Colour4& colour : colours) add_integers(values, colour);
  return values;
}

}  // namespace terrane::tiler

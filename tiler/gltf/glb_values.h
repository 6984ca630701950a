#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tiler/tile_format.h"

namespace terrane::tiler {

/// Whole lattice steps in glTF's axes: x east, y up, z south.
using Steps = std::array<std::int32_t, 3>;
using Colour4 = std::array<std::uint8_t, 4>;

/// glTF's numbers for types of components.
enum class Component {
  kByte = 5120,
  kUnsignedByte = 5121,
  kShort = 5122,
  kUnsignedShort = 5123,
  kFloat = 5126
};

/// The filters of EXT_meshopt_compression.
enum class Filter {
  kNone,
  /// Floats that are small whole multiples of a power of two: a byte of exponent, 24 bits of
  /// mantissa. Loses nothing.
  kExponential,
  /// Unit vectors: two bytes of direction, a one and a zero. Within a step and a half of the bytes.
  kOctahedral,
};

/// What one vertex attribute holds, as it lies in a buffer.
struct GlbValues {
  Component component = Component::kFloat;
  int components = 3;
  bool is_normalized = false;
  std::size_t count = 0;
  std::size_t stride = 0;  ///< bytes from one element to the next: whole words
  std::string bytes;
  Filter filter = Filter::kNone;
  std::string filtered;  ///< with a filter: what it makes the values of, as long as they are
  std::vector<double> low, high;     ///< smallest and largest per component, where they are stated
  std::array<int, 3> exponent = {};  ///< with kExponential: of the power of two, per component
};

/// Positions or displacements: 16-bit integers where all fit and \p positions allows them, else
/// floats. Exact either way.
///
/// \param step_m  of each axis, a power of two.
GlbValues values_of_steps(const std::vector<Steps>& steps, Positions positions,
                          const std::array<double, 3>& step_m);

/// Unit normals: bytes, or floats on multiples of 2^-14.
GlbValues values_of_normals(const std::vector<Eigen::Vector3f>& normals, bool as_floats);

/// Texture coordinates from 0 to 1: 16 bits, or floats on multiples of 2^-16.
GlbValues values_of_places(const std::vector<Eigen::Vector2f>& places, bool as_floats);

GlbValues values_of_colours(const std::vector<Colour4>& colours);

}  // namespace terrane::tiler

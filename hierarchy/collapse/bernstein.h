#pragma once

#include <array>
#include <cstddef>

#include "hierarchy/collapse/lanes.h"

// Polynomials over [0, 1] by their Bernstein coefficients: none of them is beyond the outermost of
// these (Farin 2002, Curves and Surfaces for CAGD, chapter 6).

namespace terrane::hierarchy {

using Quadratic = std::array<double, 3>;
using Cubic = std::array<double, 4>;

/// The same polynomial with one degree more.
inline Cubic elevated(const Quadratic& q) {
  return {q[0], (q[0] + 2 * q[1]) / 3, (2 * q[1] + q[2]) / 3, q[2]};
}

/// The halves of a polynomial in Bernstein form (de Casteljau): the first one, and \p p the second.
template <class Value, std::size_t N>
TERRANE_LANES_INLINE std::array<Value, N> split(std::array<Value, N>& p) {
  std::array<Value, N> first;
  for (std::size_t left = N; left > 0; --left) {
    first[N - left] = p[0];
    for (std::size_t i = 0; i + 1 < left; ++i) p[i] = (p[i] + p[i + 1]) * 0.5F;
  }
  return first;
}

}  // namespace terrane::hierarchy

#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

// Eight floats at once. What works on them is compiled twice from the same source, for any machine
// and for those with AVX2 (run_wide, run_portable), and the results are the same to the bit:
// neither reorders or fuses operations.

// vectors are passed between functions that are inlined only
#pragma GCC diagnostic ignored "-Wpsabi"

namespace terrane::hierarchy {

inline constexpr std::size_t kLanes = 8;
using Lanes [[gnu::vector_size(4 * kLanes)]] = float;
/// All bits set in the lanes for which something holds.
using LaneMask [[gnu::vector_size(4 * kLanes)]] = std::int32_t;

/// Half as many doubles: as wide.
using HalfLanes [[gnu::vector_size(4 * kLanes)]] = double;
using HalfMask [[gnu::vector_size(4 * kLanes)]] = std::int64_t;

#define TERRANE_LANES_INLINE [[gnu::always_inline]] inline

#if defined(__x86_64__)
#define TERRANE_FOR_WIDE_LANES [[gnu::target("avx2")]]
#else
#define TERRANE_FOR_WIDE_LANES
#endif

TERRANE_LANES_INLINE Lanes load(const float* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

TERRANE_LANES_INLINE void store(const Lanes& lanes, float* to) {
  std::memcpy(to, &lanes, sizeof lanes);
}

TERRANE_LANES_INLINE Lanes all_lanes(float value) { return Lanes{} + value; }

/// 0, 1, 2, ...
TERRANE_LANES_INLINE Lanes lane_numbers() { return Lanes{0, 1, 2, 3, 4, 5, 6, 7}; }

TERRANE_LANES_INLINE Lanes max(const Lanes& a, const Lanes& b) { return a > b ? a : b; }
TERRANE_LANES_INLINE Lanes min(const Lanes& a, const Lanes& b) { return a < b ? a : b; }
TERRANE_LANES_INLINE Lanes abs(const Lanes& a) { return max(a, -a); }

using HalfIntegers [[gnu::vector_size(2 * kLanes)]] = std::int32_t;
/// Lanes of integers or masks: the first four, or the others.
TERRANE_LANES_INLINE HalfIntegers half_of(const LaneMask& lanes, std::size_t half) {
  return half == 0 ? __builtin_shufflevector(lanes, lanes, 0, 1, 2, 3)
                   : __builtin_shufflevector(lanes, lanes, 4, 5, 6, 7);
}
TERRANE_LANES_INLINE HalfLanes as_doubles(const LaneMask& integers, std::size_t half) {
  return __builtin_convertvector(half_of(integers, half), HalfLanes);
}
TERRANE_LANES_INLINE HalfMask widened(const LaneMask& mask, std::size_t half) {
  return __builtin_convertvector(half_of(mask, half), HalfMask);
}

TERRANE_LANES_INLINE bool any(const LaneMask& mask) {
  using Halves [[gnu::vector_size(4 * kLanes)]] = std::int64_t;
  const auto bits = reinterpret_cast<Halves>(mask);
  return (bits[0] | bits[1] | bits[2] | bits[3]) != 0;
}

/// A bit for each lane, the first one lowest.
TERRANE_LANES_INLINE std::uint32_t bits_of(const LaneMask& mask) {
  std::int32_t lanes[kLanes];
  std::memcpy(lanes, &mask, sizeof lanes);
  std::uint32_t bits = 0;
  for (std::size_t k = 0; k < kLanes; ++k) bits |= (lanes[k] != 0 ? 1U : 0U) << k;
  return bits;
}

TERRANE_LANES_INLINE float sum(const Lanes& a) {
  return ((a[0] + a[1]) + (a[2] + a[3])) + ((a[4] + a[5]) + (a[6] + a[7]));
}

TERRANE_LANES_INLINE float greatest(const Lanes& a) {
  float result = a[0];
  for (std::size_t k = 1; k < kLanes; ++k) result = a[k] > result ? a[k] : result;
  return result;
}
TERRANE_LANES_INLINE float least(const Lanes& a) { return -greatest(-a); }

/// Does this machine run what TERRANE_FOR_WIDE_LANES marks?
inline bool has_wide_lanes() {
#if defined(__x86_64__)
  static const bool has_avx2 = __builtin_cpu_supports("avx2");
  return has_avx2;
#else
  return false;
#endif
}

/// work.run(), compiled for machines with AVX2. \pre has_wide_lanes()
template <class Work>
[[gnu::flatten]] TERRANE_FOR_WIDE_LANES auto run_wide(const Work& work) {
  return work.run();
}

/// The same for any machine.
template <class Work>
[[gnu::flatten]] auto run_portable(const Work& work) {
  return work.run();
}

}  // namespace terrane::hierarchy

#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace terrane::ingest {

/// A 64-bit hash of a sequence of numbers and texts; not safe against forgery.
///
/// Each 64-bit word w changes the state h to mix(h xor w) + 0x9E3779B97F4A7C15, mix being the
/// finalizer of splitmix64 (a bijection, so that two sequences that differ in one word never meet).
/// The result does not depend on the machine.
///
/// \par Source
/// Steele, Lea, Flood: Fast Splittable Pseudorandom Number Generators (2014), and Stafford's
/// "Mix13" constants.
class Fingerprint {
 public:
  void add(std::uint64_t word);
  void add(double number);                     ///< its bits
  void add(std::string_view text);             ///< its length, then its bytes
  void add_packed(std::string_view bytes);     ///< their number, then eight to a word
  void add(std::span<const float> heights_m);  ///< bits; all NaN are one, zeros of both signs too

  std::uint64_t value() const { return state_; }
  std::string hex() const;  ///< 16 digits

 private:
  std::uint64_t state_ = 0x9E3779B97F4A7C15;
};

/// splitmix64's finalizer: a bijection that spreads every bit over all others.
std::uint64_t mix(std::uint64_t word);

}  // namespace terrane::ingest

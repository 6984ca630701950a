#include "ingest/fingerprint.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace terrane::ingest {
namespace {

std::uint64_t canonical_bits(float height_m) {
  if (std::isnan(height_m)) return 0x7FC00000;
  return height_m == 0 ? 0 : std::bit_cast<std::uint32_t>(height_m);
}

}  // namespace

std::uint64_t mix(std::uint64_t word) {
  word = (word ^ (word >> 30)) * 0xBF58476D1CE4E5B9;
  word = (word ^ (word >> 27)) * 0x94D049BB133111EB;
  return word ^ (word >> 31);
}

void Fingerprint::add(std::uint64_t word) { state_ = mix(state_ ^ word) + 0x9E3779B97F4A7C15; }

void Fingerprint::add(double number) { add(std::bit_cast<std::uint64_t>(number)); }

void Fingerprint::add(std::string_view text) {
  add(static_cast<std::uint64_t>(text.size()));
  for (const char c : text) add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
}

void Fingerprint::add_packed(std::string_view bytes) {
  add(static_cast<std::uint64_t>(bytes.size()));
  for (std::size_t at = 0; at < bytes.size(); at += 8) {
    std::uint64_t word = 0;
    for (std::size_t k = 0; k < std::min<std::size_t>(8, bytes.size() - at); ++k) {
      word |= std::uint64_t{static_cast<unsigned char>(bytes[at + k])} << (8 * k);
    }
    add(word);
  }
}

void Fingerprint::add(std::span<const float> heights_m) {
  for (const float height_m : heights_m) add(canonical_bits(height_m));
}

std::string Fingerprint::hex() const { return fmt::format("{:016x}", state_); }

}  // namespace terrane::ingest

#include "hierarchy/merge/packed_numbers.h"

#include <array>
#include <cstdlib>
#include <limits>

#include "core/errors.h"

namespace terrane::hierarchy {

void PackedWriter::number(std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) bytes_ += static_cast<char>(value | 0x80);
  bytes_ += static_cast<char>(value);
}

void PackedWriter::signed_number(std::int64_t value) {
  number((static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63));
}

void PackedWriter::difference(const Eigen::Vector3i& value, const Eigen::Vector3i& from) {
  for (int axis = 0; axis < 3; ++axis) {
    signed_number(std::int64_t{value[axis]} - std::int64_t{from[axis]});
  }
}

void PackedWriter::fixed16(std::uint32_t value) {
  for (int shift = 0; shift < 16; shift += 8) bytes_ += static_cast<char>(value >> shift & 0xff);
}

void PackedWriter::fixed32(std::uint32_t value) {
  fixed16(value & 0xffff);
  fixed16(value >> 16);
}

std::uint32_t PackedReader::byte() {
  if (at_ == bytes_.size()) damaged();
  return static_cast<unsigned char>(bytes_[at_++]);
}

std::uint64_t PackedReader::number() {
  std::uint64_t value = 0;
  for (int shift = 0; shift < 64; shift += 7) {
    const std::uint32_t part = byte();
    value |= std::uint64_t{part & 0x7f} << shift;
    if (part < 0x80) return value;
  }
  damaged();
}

std::int64_t PackedReader::signed_number() {
  const std::uint64_t value = number();
  return static_cast<std::int64_t>(value >> 1) ^ -static_cast<std::int64_t>(value & 1);
}

Eigen::Vector3i PackedReader::sum(const Eigen::Vector3i& from) {
  Eigen::Vector3i value;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t step = signed_number();
    constexpr std::int64_t kMost = std::numeric_limits<int>::max();
    if (step < -2 * kMost || step > 2 * kMost) damaged();
    const std::int64_t sum = from[axis] + step;
    if (std::abs(sum) > kMost) damaged();
    value[axis] = static_cast<int>(sum);
  }
  return value;
}

std::uint32_t PackedReader::id_near(std::uint32_t from, std::uint64_t limit) {
  const std::int64_t step = signed_number();
  constexpr std::int64_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (step < -kMost || step > kMost) damaged();
  const std::int64_t value = std::int64_t{from} + step;
  if (value < 0 || static_cast<std::uint64_t>(value) >= limit) damaged();
  return static_cast<std::uint32_t>(value);
}

std::uint32_t PackedReader::fixed16() {
  const std::uint32_t low = byte();
  return low | byte() << 8;
}

std::uint32_t PackedReader::fixed32() {
  const std::uint32_t low = fixed16();
  return low | fixed16() << 16;
}

void PackedReader::damaged() const {
  throw InputError(file_ + ": is damaged or breaks off. Build it again");
}

std::uint32_t crc32_of(std::string_view bytes) {
  static constexpr auto kTable = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t value = i;
      for (int bit = 0; bit < 8; ++bit) value = value >> 1 ^ (value & 1 ? 0xedb88320U : 0);
      table[i] = value;
    }
    return table;
  }();
  std::uint32_t sum = ~std::uint32_t{0};
  for (const char c : bytes) sum = sum >> 8 ^ kTable[(sum ^ static_cast<unsigned char>(c)) & 0xff];
  return ~sum;
}

}  // namespace terrane::hierarchy

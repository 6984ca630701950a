#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>

namespace terrane::hierarchy {

/// Appends numbers to bytes: 7 bits a byte, the lowest first; signed ones with the sign as the
/// lowest bit. Fixed-size ones are little-endian.
class PackedWriter {
 public:
  void number(std::uint64_t value);
  void signed_number(std::int64_t value);
  void difference(const Eigen::Vector3i& value, const Eigen::Vector3i& from);
  void fixed16(std::uint32_t value);
  void fixed32(std::uint32_t value);
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Reads what PackedWriter wrote; never beyond the end.
///
/// Every function throws InputError, as damaged() does, where bytes are missing or a value does not
/// fit its type.
class PackedReader {
 public:
  /// \param file  named in messages.
  PackedReader(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  std::uint64_t number();
  std::int64_t signed_number();
  Eigen::Vector3i sum(const Eigen::Vector3i& from);
  /// A number below a limit, stored as the difference from another.
  std::uint32_t id_near(std::uint32_t from, std::uint64_t limit);
  std::uint32_t fixed16();
  std::uint32_t fixed32();
  bool is_at_end() const { return at_ == bytes_.size(); }
  [[noreturn]] void damaged() const;

 private:
  std::uint32_t byte();

  std::string_view bytes_;
  const std::string& file_;
  std::size_t at_ = 0;
};

/// CRC-32 (that of zip and PNG) of some bytes.
std::uint32_t crc32_of(std::string_view bytes);

}  // namespace terrane::hierarchy

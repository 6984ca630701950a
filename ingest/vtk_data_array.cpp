#include "ingest/vtk_data_array.h"

#include <cpl_conv.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <map>

#include "core/errors.h"

namespace terrane::ingest {
namespace {

static_assert(std::endian::native == std::endian::little, "bytes are taken as they lie");

constexpr std::string_view kSpace = " \t\r\n";
constexpr std::uint64_t kMostBlocks = 1 << 24;
constexpr std::uint64_t kMostInflation = 1032;  // by zlib, of what could not be shorter

[[noreturn]] void refuse_short() {
  throw InputError("the data end before the array does. Write the file again");
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  if (c == '/') return 63;
  throw InputError(fmt::format("'{}' is no base64 digit. Write the file again", c));
}

/// Bytes from the front of coded or raw data.
class ByteStream {
 public:
  ByteStream(std::string_view data, bool is_base64) : data_(data), is_base64_(is_base64) {}

  std::string take(std::uint64_t count) {
    // counts are read from the file: a damaged one must not ask for all memory there is
    if (count > left()) refuse_short();
    if (!is_base64_) {
      const std::string_view bytes = data_.substr(0, count);
      data_.remove_prefix(count);
      return std::string(bytes);
    }
    while (decoded_.size() < count) decode_four();
    std::string bytes = decoded_.substr(0, count);
    decoded_.erase(0, count);
    return bytes;
  }

  std::size_t left() const { return data_.size() + decoded_.size(); }

 private:
  // a padded group ends one coded piece, the next one follows: four digits at a time serve both
  void decode_four() {
    std::uint32_t bits = 0;
    int digits = 0, padding = 0;
    while (digits + padding < 4) {
      data_.remove_prefix(std::min(data_.find_first_not_of(kSpace), data_.size()));
      if (data_.empty()) refuse_short();
      const char c = data_.front();
      data_.remove_prefix(1);
      if (c == '=') {
        ++padding;
      } else {
        bits |= static_cast<std::uint32_t>(base64_digit(c)) << (18 - 6 * digits++);
      }
    }
    for (int k = 0; k < 3 - padding; ++k) {
      decoded_.push_back(static_cast<char>(bits >> (16 - 8 * k) & 0xff));
    }
  }

  std::string_view data_;
  bool is_base64_;
  std::string decoded_;
};

template <class T>
T number_at(const char* bytes, bool is_big_endian) {
  char ordered[sizeof(T)];
  std::copy_n(bytes, sizeof(T), ordered);
  if (is_big_endian) std::reverse(ordered, ordered + sizeof(T));
  T number;
  std::memcpy(&number, ordered, sizeof(T));
  return number;
}

std::uint64_t take_count(ByteStream& stream, const VtkEncoding& encoding) {
  const std::string bytes = stream.take(static_cast<std::uint64_t>(encoding.header_bytes));
  return encoding.header_bytes == 8
             ? number_at<std::uint64_t>(bytes.data(), encoding.is_big_endian)
             : number_at<std::uint32_t>(bytes.data(), encoding.is_big_endian);
}

std::string inflate(const std::string& packed, std::uint64_t size) {
  std::string bytes(size, '\0');
  std::size_t written = 0;
  if (CPLZLibInflate(packed.data(), packed.size(), bytes.data(), bytes.size(), &written) ==
          nullptr ||
      written != size) {
    throw InputError("a block cannot be inflated. Write the file again");
  }
  return bytes;
}

/// Header: number of blocks, size of each, size of a last shorter one or 0, sizes when packed.
std::string take_blocks(ByteStream& stream, const VtkEncoding& encoding) {
  const std::uint64_t blocks = take_count(stream, encoding);
  const std::uint64_t size = take_count(stream, encoding);
  const std::uint64_t last = take_count(stream, encoding);
  const bool is_sound = blocks <= kMostBlocks && last <= size &&
                        (blocks == 0 || size / kMostInflation <= stream.left() / blocks);
  if (!is_sound) {
    throw InputError("the header of the packed data makes no sense. Write the file again");
  }
  std::vector<std::uint64_t> packed;
  for (std::uint64_t k = 0; k < blocks; ++k) packed.push_back(take_count(stream, encoding));
  std::string bytes;
  for (std::uint64_t k = 0; k < blocks; ++k) {
    bytes += inflate(stream.take(packed[k]), k + 1 == blocks && last > 0 ? last : size);
  }
  return bytes;
}

template <class T>
std::vector<double> numbers_in(const std::string& bytes, bool is_big_endian) {
  std::vector<double> numbers;
  numbers.reserve(bytes.size() / sizeof(T));
  for (std::size_t at = 0; at + sizeof(T) <= bytes.size(); at += sizeof(T)) {
    numbers.push_back(static_cast<double>(number_at<T>(bytes.data() + at, is_big_endian)));
  }
  return numbers;
}

using Decoder = std::vector<double> (*)(const std::string&, bool);

const std::map<std::string, Decoder> kDecoders = {
    {"Float32", numbers_in<float>},      {"Float64", numbers_in<double>},
    {"Int8", numbers_in<std::int8_t>},   {"UInt8", numbers_in<std::uint8_t>},
    {"Int16", numbers_in<std::int16_t>}, {"UInt16", numbers_in<std::uint16_t>},
    {"Int32", numbers_in<std::int32_t>}, {"UInt32", numbers_in<std::uint32_t>},
    {"Int64", numbers_in<std::int64_t>}, {"UInt64", numbers_in<std::uint64_t>},
};

}  // namespace

std::vector<double> parse_vtk_ascii(std::string_view text) {
  std::vector<double> numbers;
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
    if (text.empty()) return numbers;
    const std::string_view word = text.substr(0, text.find_first_of(kSpace));
    double number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size()) {
      throw InputError(fmt::format("'{}' is no number", word.substr(0, 40)));
    }
    numbers.push_back(number);
    text.remove_prefix(word.size());
  }
}

std::vector<double> decode_vtk_binary(std::string_view data, bool is_base64,
                                      const std::string& type, const VtkEncoding& encoding) {
  const auto decoder = kDecoders.find(type);
  if (decoder == kDecoders.end()) {
    throw InputError(fmt::format("numbers of type '{}' cannot be read. Write Float64", type));
  }
  ByteStream stream(data, is_base64);
  const std::string bytes =
      encoding.is_zlib ? take_blocks(stream, encoding) : stream.take(take_count(stream, encoding));
  return decoder->second(bytes, encoding.is_big_endian);
}

}  // namespace terrane::ingest

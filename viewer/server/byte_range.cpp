#include "viewer/server/byte_range.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>

namespace terrane::viewer {
namespace {

// A number too large for 64 bits is past the end of any file, and stays a number.
std::optional<std::uint64_t> parse_position(std::string_view digits) {
  std::uint64_t value = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stopped_at, error] = std::from_chars(digits.data(), end, value);
  if (digits.empty() || stopped_at != end || error == std::errc::invalid_argument) {
    return std::nullopt;
  }
  if (error == std::errc::result_out_of_range) return std::numeric_limits<std::uint64_t>::max();
  return value;
}

}  // namespace

std::variant<WholeFile, NoSuchBytes, ByteRange> parse_byte_range(std::string_view header,
                                                                 std::uint64_t bytes) {
  constexpr std::string_view unit = "bytes=";
  if (!header.starts_with(unit)) return WholeFile{};
  const std::string_view range = header.substr(unit.size());
  const std::size_t dash = range.find('-');
  if (dash == std::string_view::npos) return WholeFile{};
  const auto first = parse_position(range.substr(0, dash));
  const auto last = parse_position(range.substr(dash + 1));

  if (dash == 0) {  // "-n": the last n bytes
    if (!last) return WholeFile{};
    const std::uint64_t length = std::min(*last, bytes);
    if (length == 0) return NoSuchBytes{};
    return ByteRange{bytes - length, length};
  }
  const bool is_open_ended = dash + 1 == range.size();
  if (!first || (!last && !is_open_ended) || (last && *last < *first)) return WholeFile{};
  if (*first >= bytes) return NoSuchBytes{};
  const std::uint64_t end = is_open_ended || *last >= bytes ? bytes : *last + 1;
  return ByteRange{*first, end - *first};
}

}  // namespace terrane::viewer

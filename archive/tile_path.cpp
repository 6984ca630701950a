#include "archive/tile_path.h"

#include <fmt/format.h>

#include <charconv>

namespace terrane::archive {
namespace {

constexpr std::string_view kNumbers = "{l}/{x}/{y}";

// "007" is another name than "7", and would come back as that
std::optional<std::uint32_t> parse_number(std::string_view digits) {
  if (digits.empty() || (digits.front() == '0' && digits.size() > 1)) return std::nullopt;
  std::uint32_t value = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stopped_at, error] = std::from_chars(digits.data(), end, value);
  if (stopped_at != end || error != std::errc()) return std::nullopt;
  return value;
}

/// Cuts off and returns what follows the last slash.
std::string_view take_last_part(std::string_view& name) {
  const std::size_t slash = name.rfind('/');
  const std::string_view part = slash == std::string_view::npos ? name : name.substr(slash + 1);
  name = slash == std::string_view::npos ? std::string_view() : name.substr(0, slash);
  return part;
}

}  // namespace

std::optional<TileName> parse_tile_name(std::string_view name) {
  std::string_view rest = name;
  std::string_view last = take_last_part(rest);
  const std::size_t dot = last.find('.');
  if (dot == std::string_view::npos || dot + 1 == last.size()) return std::nullopt;
  const auto y = parse_number(last.substr(0, dot));
  const auto x = parse_number(take_last_part(rest));
  const auto level = parse_number(take_last_part(rest));
  if (!y || !x || !level) return std::nullopt;
  return TileName{.before = rest.empty() ? std::string() : std::string(rest) + "/",
                  .numbers = {*level, *x, *y},
                  .extension = std::string(last.substr(dot))};
}

std::optional<TilePath> TilePath::parse(std::string_view pattern, std::int64_t first_zoom,
                                        std::int64_t zoom_step) {
  const std::size_t at = pattern.find(kNumbers);
  const bool is_good = at != std::string_view::npos && first_zoom >= 0 &&
                       first_zoom <= kLargestZoom && (zoom_step == 1 || zoom_step == -1);
  if (!is_good) return std::nullopt;
  return TilePath(std::string(pattern.substr(0, at)),
                  std::string(pattern.substr(at + kNumbers.size())), static_cast<int>(first_zoom),
                  static_cast<int>(zoom_step));
}

std::optional<ZoomTile> TilePath::place_of(const TileNumbers& numbers) const {
  const std::int64_t zoom = first_zoom_ + zoom_step_ * std::int64_t{numbers.level};
  if (zoom < 0 || zoom > kLargestZoom) return std::nullopt;
  const std::uint64_t side = std::uint64_t{1} << zoom;
  if (numbers.x >= side || numbers.y >= side) return std::nullopt;
  return ZoomTile{static_cast<int>(zoom), numbers.x, numbers.y};
}

std::optional<ZoomTile> TilePath::place_of(std::string_view name) const {
  const auto parsed = parse_tile_name(name);
  if (!parsed || parsed->before != before_ || parsed->extension != extension_) return std::nullopt;
  return place_of(parsed->numbers);
}

std::optional<std::string> TilePath::name_of(const ZoomTile& tile) const {
  const int level = (tile.zoom - first_zoom_) * zoom_step_;
  if (level < 0) return std::nullopt;
  return fmt::format("{}{}/{}/{}{}", before_, level, tile.x, tile.y, extension_);
}

}  // namespace terrane::archive

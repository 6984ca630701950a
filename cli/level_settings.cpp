#include "cli/level_settings.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <string_view>

#include "core/errors.h"

namespace terrane::cli {
namespace {

/// The whole text as a number that is not negative.
template <class T>
std::optional<T> number_of(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !(value >= 0))
    return std::nullopt;
  return value;
}

}  // namespace

StopRule stop_of(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string_view what = std::string_view(text).substr(0, equals);
  const std::string_view value =
      equals == std::string::npos ? std::string_view() : std::string_view(text).substr(equals + 1);
  StopRule rule;
  if (what == "error") {
    rule.most_error = number_of<double>(value);
    if (rule.most_error) return rule;
  } else if (const auto count = number_of<std::uint32_t>(value)) {
    if (what == "level") rule.most_levels = *count;
    if (what == "triangles") rule.fewest_triangles = *count;
    if (what == "level" || what == "triangles") return rule;
  }
  throw ConfigError(fmt::format(
      "--stop {}: is none of level=N, triangles=N, error=E, with a number of 0 or more", text));
}

hierarchy::Weights weights_of(const std::string& text) {
  if (text == "st-helens" || text == "saddle") return hierarchy::kStHelensWeights;
  if (text == "crater-lake" || text == "torus") return hierarchy::kCraterLakeWeights;
  std::array<double, 4> values{};
  std::string_view rest = text;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t comma = i + 1 < values.size() ? rest.find(',') : rest.size();
    const auto value =
        comma == std::string_view::npos ? std::nullopt : number_of<double>(rest.substr(0, comma));
    if (!value || *value > 1) {
      throw ConfigError(
          fmt::format("--weights {}: is neither st-helens, saddle, crater-lake or torus nor four "
                      "numbers from 0 "
                      "to 1: curvature,angle,valence,error",
                      text));
    }
    values[i] = *value;
    rest.remove_prefix(std::min(rest.size(), comma + 1));
  }
  return {values[0], values[1], values[2], values[3]};
}

}  // namespace terrane::cli

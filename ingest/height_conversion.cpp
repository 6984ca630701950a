#include "ingest/height_conversion.h"

#include <cpl_conv.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/errors.h"
#include "core/height_grid.h"

namespace terrane::ingest {
namespace {

constexpr double kLargestFloat = std::numeric_limits<float>::max();

// programs write their lowest float with different digits, -3.4e38 and 3.4028235e+38 among them, so
// all of them are one value here
constexpr double kLowestFloatHabit = -3.39e38;

bool is_same_nodata(double stored, double nodata) {
  return stored == nodata || (nodata <= kLowestFloatHabit && stored <= kLowestFloatHabit);
}

double parse_number(const std::string& text, const std::string& file) {
  char* end = nullptr;
  // not std::strtod, which takes a decimal comma in some locales
  const double value = CPLStrtod(text.c_str(), &end);
  if (text.empty() || *end != '\0') {
    throw ConfigError(
        fmt::format("{}: '{}' is no value for --nodata. Give a number, several with "
                    "commas between them, or none",
                    file, text));
  }
  return value;
}

}  // namespace

float HeightConversion::height_m(double stored) const {
  const auto is_stored = [stored](double value) { return is_same_nodata(stored, value); };
  if (std::any_of(nodata.begin(), nodata.end(), is_stored)) return kNoHeight;
  const double height = (stored * scale + offset) * metres_per_unit;
  // false for NaN too
  return std::abs(height) <= kLargestFloat ? static_cast<float>(height) : kNoHeight;
}

std::vector<double> parse_nodata(const std::string& text, const std::string& file) {
  std::vector<double> values;
  if (text == "none") return values;
  std::size_t begin = 0;
  while (true) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    values.push_back(parse_number(text.substr(begin, comma - begin), file));
    if (comma == text.size()) return values;
    begin = comma + 1;
  }
}

double rounded_to_float(double nodata) {
  if (!std::isfinite(nodata)) return nodata;
  return static_cast<float>(std::clamp(nodata, -kLargestFloat, kLargestFloat));
}

std::vector<SuspectHeight> suspects_of(const HeightConversion& conversion) {
  std::vector<SuspectHeight> suspects;
  for (const double stored : {-32767.0, -32768.0, -9999.0}) {
    const float height_m = conversion.height_m(stored);
    if (!std::isnan(height_m)) suspects.push_back({fmt::format("{}", stored), height_m, false});
  }
  const float lowest_m = conversion.height_m(kLowestFloatHabit);
  if (!std::isnan(lowest_m)) suspects.push_back({"-3.4e38", lowest_m, true});
  return suspects;
}

}  // namespace terrane::ingest

#include "ingest/vertical_unit.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string>

namespace terrane::ingest {
namespace {

constexpr std::array kUnits = {VerticalUnit::kMetre, VerticalUnit::kFoot,
                               VerticalUnit::kUsSurveyFoot};

// only letters, in lower case: "US survey foot", "us-survey-foot" and "US_Survey_Foot" are one word
std::string letters_of(std::string_view word) {
  std::string letters;
  for (const char c : word) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalpha(byte)) letters += static_cast<char>(std::tolower(byte));
  }
  return letters;
}

template <std::size_t N>
bool is_one_of(const std::string& word, const std::array<std::string_view, N>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

double metres_per_unit(VerticalUnit unit) {
  switch (unit) {
    case VerticalUnit::kMetre:
      return 1.0;
    case VerticalUnit::kFoot:
      return 0.3048;
    case VerticalUnit::kUsSurveyFoot:
      return 1200.0 / 3937.0;
  }
  return 1.0;
}

std::string_view name_of(VerticalUnit unit) {
  switch (unit) {
    case VerticalUnit::kMetre:
      return "metre";
    case VerticalUnit::kFoot:
      return "foot";
    case VerticalUnit::kUsSurveyFoot:
      return "us-survey-foot";
  }
  return "metre";
}

std::optional<VerticalUnit> parse_vertical_unit(std::string_view word) {
  for (const VerticalUnit unit : kUnits) {
    if (word == name_of(unit)) return unit;
  }
  return std::nullopt;
}

std::optional<VerticalUnit> recognise_vertical_unit(std::string_view word_in_file) {
  static constexpr std::array<std::string_view, 5> kMetreWords = {"m", "metre", "metres", "meter",
                                                                  "meters"};
  static constexpr std::array<std::string_view, 5> kFootWords = {
      "ft", "foot", "feet", "internationalfoot", "internationalfeet"};
  static constexpr std::array<std::string_view, 9> kUsFootWords = {
      "usft", "ftus",         "footus",       "usfoot",    "usfeet",
      "sft",  "ussurveyfoot", "ussurveyfeet", "surveyfoot"};
  const std::string word = letters_of(word_in_file);
  if (is_one_of(word, kMetreWords)) return VerticalUnit::kMetre;
  if (is_one_of(word, kFootWords)) return VerticalUnit::kFoot;
  if (is_one_of(word, kUsFootWords)) return VerticalUnit::kUsSurveyFoot;
  return std::nullopt;
}

std::optional<VerticalUnit> recognise_vertical_unit(double length_m) {
  for (const VerticalUnit unit : kUnits) {
    if (std::abs(length_m - metres_per_unit(unit)) < 1e-9) return unit;
  }
  return std::nullopt;
}

}  // namespace terrane::ingest

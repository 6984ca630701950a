#include "archive/geographic_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <optional>

namespace terrane::archive {
namespace {

using nlohmann::json;

constexpr double kMetresPerDegree = 111'000;  // a bit less than anywhere: the bounds contain

std::optional<GeographicBounds> stated_bounds(const json& file) {
  if (!file.is_object() || !file.contains("bounds")) return std::nullopt;
  const auto numbers = file["bounds"].get<std::array<double, 4>>();
  return GeographicBounds{
      std::clamp(numbers[0], -180.0, 180.0), std::clamp(numbers[1], -90.0, 90.0),
      std::clamp(numbers[2], -180.0, 180.0), std::clamp(numbers[3], -90.0, 90.0)};
}

GeographicBounds around(double longitude_deg, double latitude_deg,
                        const std::array<double, 12>& box) {
  const double reach_m =
      std::hypot(std::hypot(box[0], box[1]),
                 std::sqrt(std::inner_product(box.begin() + 3, box.end(), box.begin() + 3, 0.0)));
  const double reach_deg = reach_m / kMetresPerDegree;
  const double shrink = std::cos(latitude_deg * std::numbers::pi / 180);
  const double east_reach_deg = shrink * 180 > reach_deg ? reach_deg / shrink : 180;
  return {
      std::max(longitude_deg - east_reach_deg, -180.0), std::max(latitude_deg - reach_deg, -90.0),
      std::min(longitude_deg + east_reach_deg, 180.0), std::min(latitude_deg + reach_deg, 90.0)};
}

GeographicBounds find_bounds(const json& files) {
  for (const auto& file : files) {
    if (const auto bounds = stated_bounds(file)) return *bounds;
  }
  const json& frame = files.at("terrane.json").at("frame");
  const auto box = files.at("tileset.json").at("root").at("boundingVolume").at("box");
  return around(frame.at("longitude_deg"), frame.at("latitude_deg"),
                box.get<std::array<double, 12>>());
}

}  // namespace

GeographicBounds bounds_of(std::string_view files) {
  try {
    return find_bounds(json::parse(files));
  } catch (const json::exception&) {
    return {};  // a local frame, or a format without bounds: the header has to say something
  }
}

}  // namespace terrane::archive

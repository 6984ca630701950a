#include "tiler/verify/picture_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tiler/verify/report.h"

namespace terrane::verify {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, kPictureFaults> kNames = {"missing", "unexpected", "unreadable",
                                                            "off_dem", "means",      "misstated"};

}  // namespace

bool PictureZoomReport::holds() const {
  return std::ranges::all_of(faults, [](std::int64_t count) { return count == 0; });
}

bool PictureReport::holds() const {
  return !zooms.empty() &&
         std::ranges::all_of(zooms, [](const PictureZoomReport& zoom) { return zoom.holds(); });
}

std::string to_text(const PictureReport& report) {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{:>5} {:>7} {:>11} {:>10} {:>11} {:>11}", "zoom", "tiles", "bytes", "pixels",
                 "max_diff_m", "rms_diff_m");
  for (const char* name : kNames) fmt::format_to(out, " {:>10}", name);
  text += '\n';
  for (const PictureZoomReport& zoom : report.zooms) {
    fmt::format_to(out, "{:>5} {:>7} {:>11} {:>10} {:>11.5g} {:>11.5g}", zoom.zoom, zoom.tiles,
                   zoom.bytes, zoom.pixels, zoom.max_difference_m, zoom.rms_difference_m);
    for (const std::int64_t count : zoom.faults) fmt::format_to(out, " {:>10}", count);
    text += '\n';
  }
  return text + verdict_text(report.problems, report.problems_left_out, report.holds());
}

std::string to_json(const PictureReport& report) {
  Json object = {{"holds", report.holds()}, {"zooms", Json::array()}};
  for (const PictureZoomReport& zoom : report.zooms) {
    Json of = {{"zoom", zoom.zoom},
               {"holds", zoom.holds()},
               {"tiles", zoom.tiles},
               {"bytes", zoom.bytes},
               {"pixels", zoom.pixels},
               {"max_difference_m", zoom.max_difference_m},
               {"rms_difference_m", zoom.rms_difference_m}};
    for (std::size_t k = 0; k < kPictureFaults; ++k) of["faults"][kNames[k]] = zoom.faults[k];
    object["zooms"].push_back(std::move(of));
  }
  object["problems"] = report.problems;
  object["problems_left_out"] = report.problems_left_out;
  return object.dump(2) + "\n";
}

}  // namespace terrane::verify

#include "tiler/verify/terrain_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tiler/verify/report.h"

namespace terrane::verify {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, kTerrainFaults> kNames = {
    "missing", "unexpected", "unreadable", "indices", "folded", "cover",    "edge_lists", "borders",
    "heights", "spheres",    "horizon",    "normals", "water",  "metadata", "misstated"};

Json to_json(const TerrainZoomReport& zoom) {
  Json object = {{"zoom", zoom.zoom},
                 {"holds", zoom.holds()},
                 {"tolerance_m", zoom.tolerance_m},
                 {"is_held_to_dem", zoom.is_held_to_dem},
                 {"tiles", zoom.tiles},
                 {"triangles", zoom.triangles},
                 {"bytes", zoom.bytes},
                 {"max_error_m", zoom.max_error_m},
                 {"rms_error_m", zoom.rms_error_m},
                 {"samples", zoom.samples},
                 {"uncovered_samples", zoom.uncovered_samples},
                 {"samples_over_tolerance", zoom.samples_over_tolerance},
                 {"border_vertices", zoom.border_vertices}};
  for (std::size_t k = 0; k < kTerrainFaults; ++k) object["faults"][kNames[k]] = zoom.faults[k];
  return object;
}

}  // namespace

std::string name_of(TerrainFault fault) { return kNames[static_cast<std::size_t>(fault)]; }

bool TerrainZoomReport::holds() const {
  return uncovered_samples == 0 && samples_over_tolerance == 0 &&
         std::ranges::all_of(faults, [](std::int64_t count) { return count == 0; });
}

bool TerrainReport::holds() const {
  return !zooms.empty() &&
         std::ranges::all_of(zooms, [](const TerrainZoomReport& zoom) { return zoom.holds(); });
}

std::string to_text(const TerrainReport& report) {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{:>5} {:>11} {:>8} {:>7} {:>10} {:>11} {:>11} {:>11} {:>9} {:>9}\n", "zoom",
                 "tolerance_m", "held_to", "tiles", "triangles", "bytes", "max_error_m",
                 "rms_error_m", "over", "uncovered");
  for (const TerrainZoomReport& zoom : report.zooms) {
    fmt::format_to(out,
                   "{:>5} {:>11.6g} {:>8} {:>7} {:>10} {:>11} {:>11.5g} {:>11.5g} {:>9} {:>9}\n",
                   zoom.zoom, zoom.tolerance_m, zoom.is_held_to_dem ? "DEM" : "posts", zoom.tiles,
                   zoom.triangles, zoom.bytes, zoom.max_error_m, zoom.rms_error_m,
                   zoom.is_held_to_dem ? fmt::format("{}", zoom.samples_over_tolerance) : "-",
                   zoom.uncovered_samples);
  }
  fmt::format_to(out, "\n{:>5} {:>15}", "zoom", "border_vertices");
  for (const char* name : kNames) fmt::format_to(out, " {:>10}", name);
  text += '\n';
  for (const TerrainZoomReport& zoom : report.zooms) {
    fmt::format_to(out, "{:>5} {:>15}", zoom.zoom, zoom.border_vertices);
    for (const std::int64_t count : zoom.faults) fmt::format_to(out, " {:>10}", count);
    text += '\n';
  }
  return text + verdict_text(report.problems, report.problems_left_out, report.holds());
}

std::string to_json(const TerrainReport& report) {
  Json object = {{"holds", report.holds()}, {"zooms", Json::array()}};
  for (const TerrainZoomReport& zoom : report.zooms) object["zooms"].push_back(to_json(zoom));
  object["problems"] = report.problems;
  object["problems_left_out"] = report.problems_left_out;
  return object.dump(2) + "\n";
}

}  // namespace terrane::verify

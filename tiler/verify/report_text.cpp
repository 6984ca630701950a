#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "tiler/verify/report.h"

namespace terrane::verify {
namespace {

using Json = nlohmann::ordered_json;
using Buffer = std::back_insert_iterator<std::string>;

void print_errors(const VerifyReport& report, Buffer out) {
  fmt::format_to(out, "{:>5} {:>11} {:>7} {:>10} {:>11} {:>11} {:>11} {:>9} {:>9} {:>7}\n", "level",
                 "tolerance_m", "tiles", "triangles", "bytes", "max_error_m", "rms_error_m", "over",
                 "uncovered", "folded");
  for (const LevelReport& level : report.levels) {
    fmt::format_to(out,
                   "{:>5} {:>11.6g} {:>7} {:>10} {:>11} {:>11.5g} {:>11.5g} {:>9} {:>9} {:>7}\n",
                   level.level, level.tolerance_m, level.tiles, level.triangles, level.bytes,
                   level.max_error_m, level.rms_error_m, level.samples_over_tolerance,
                   level.uncovered_samples, level.folded_triangles);
  }
}

void print_seams(const VerifyReport& report, Buffer out) {
  fmt::format_to(out, "\n{:>5} {:>13} {:>10} {:>10} {:>6} {:>14} {:>12}\n", "level",
                 "seam_vertices", "mismatched", "across_lod", "torn", "parent_missing",
                 "parent_extra");
  for (const LevelReport& level : report.levels) {
    fmt::format_to(out, "{:>5} {:>13} {:>10} {:>10} {:>6} {:>14} {:>12}\n", level.level,
                   level.seam_vertices, level.mismatched_same_level, level.mismatched_across_levels,
                   level.torn_edges, level.parent_triangles_missing, level.parent_triangles_extra);
  }
}

/// All moments of a level's morph as one: the worst error and when, the sums of the rest.
MorphReport worst_of(const std::vector<MorphReport>& moments) {
  MorphReport worst;
  for (const MorphReport& moment : moments) {
    if (moment.max_error_m > worst.max_error_m) {
      worst.t = moment.t;
      worst.max_error_m = moment.max_error_m;
    }
    worst.samples_over_tolerance += moment.samples_over_tolerance;
    worst.uncovered_samples += moment.uncovered_samples;
    worst.folded_triangles += moment.folded_triangles;
  }
  return worst;
}

void print_morphs(const VerifyReport& report, Buffer out) {
  fmt::format_to(out, "\n{:>5} {:>7} {:>11} {:>6} {:>9} {:>9} {:>7}\n", "level", "moments",
                 "max_error_m", "at_t", "over", "uncovered", "folded");
  for (const LevelReport& level : report.levels) {
    if (!level.has_morph()) continue;
    const MorphReport worst = worst_of(level.morph);
    fmt::format_to(out, "{:>5} {:>7} {:>11.5g} {:>6} {:>9} {:>9} {:>7}\n", level.level,
                   level.morph.size(), worst.max_error_m, worst.t, worst.samples_over_tolerance,
                   worst.uncovered_samples, worst.folded_triangles);
  }
}

void print_listing(const VerifyReport& report, Buffer out) {
  fmt::format_to(out, "\n{:>5} {:>6} {:>7} {:>11} {:>8} {:>11} {:>10} {:>12}\n", "level", "boxes",
                 "nesting", "understated", "missing", "unexpected", "misstated", "root_morphs");
  for (const LevelReport& level : report.levels) {
    fmt::format_to(out, "{:>5} {:>6} {:>7} {:>11} {:>8} {:>11} {:>10} {:>12}\n", level.level,
                   level.boxes_violated, level.nested_errors_violated, level.stated_error_too_small,
                   level.tiles_missing, level.tiles_unexpected, level.facts_misstated,
                   level.root_morphs);
  }
}

void print_water(const VerifyReport& report, Buffer out) {
  const auto has_water = [](const LevelReport& level) {
    return level.water_triangles > 0 || level.samples_on_wrong_side > 0;
  };
  if (std::ranges::any_of(report.levels, has_water)) {
    fmt::format_to(out, "\n{:>5} {:>6} {:>7} {:>11}\n", "level", "water", "uneven", "wrong_side");
    for (const LevelReport& level : report.levels) {
      fmt::format_to(out, "{:>5} {:>6} {:>7} {:>11}\n", level.level, level.water_triangles,
                     level.uneven_water_triangles, level.samples_on_wrong_side);
    }
  }
  if (report.samples_under_water > 0 || report.water_samples_wrong > 0) {
    fmt::format_to(out, "\n{} samples in water, {} samples at another height than their own\n",
                   report.samples_under_water, report.water_samples_wrong);
  }
}

Json to_json(const MorphReport& morph) {
  return {{"t", morph.t},
          {"max_error_m", morph.max_error_m},
          {"samples_over_tolerance", morph.samples_over_tolerance},
          {"uncovered_samples", morph.uncovered_samples},
          {"folded_triangles", morph.folded_triangles}};
}

Json to_json(const LevelReport& level) {
  Json object = {{"level", level.level},
                 {"holds", level.holds()},
                 {"tolerance_m", level.tolerance_m},
                 {"tiles", level.tiles},
                 {"triangles", level.triangles},
                 {"bytes", level.bytes},
                 {"max_error_m", level.max_error_m},
                 {"rms_error_m", level.rms_error_m},
                 {"samples", level.samples},
                 {"uncovered_samples", level.uncovered_samples},
                 {"samples_over_tolerance", level.samples_over_tolerance},
                 {"folded_triangles", level.folded_triangles},
                 {"seam_vertices", level.seam_vertices},
                 {"mismatched_same_level", level.mismatched_same_level},
                 {"mismatched_across_levels", level.mismatched_across_levels},
                 {"torn_edges", level.torn_edges},
                 {"parent_triangles_missing", level.parent_triangles_missing},
                 {"parent_triangles_extra", level.parent_triangles_extra},
                 {"root_morphs", level.root_morphs},
                 {"water_triangles", level.water_triangles},
                 {"uneven_water_triangles", level.uneven_water_triangles},
                 {"samples_on_wrong_side", level.samples_on_wrong_side},
                 {"boxes_violated", level.boxes_violated},
                 {"nested_errors_violated", level.nested_errors_violated},
                 {"stated_error_too_small", level.stated_error_too_small},
                 {"tiles_missing", level.tiles_missing},
                 {"tiles_unexpected", level.tiles_unexpected},
                 {"facts_misstated", level.facts_misstated},
                 {"morph", Json::array()}};
  for (const MorphReport& morph : level.morph) object["morph"].push_back(to_json(morph));
  return object;
}

}  // namespace

std::string verdict_text(const std::vector<std::string>& problems, std::int64_t left_out,
                         bool holds) {
  std::string text = "\n";
  for (const std::string& problem : problems) text += problem + "\n";
  if (left_out > 0) text += fmt::format("... and {} more problems\n", left_out);
  return text + (holds ? "All invariants hold.\n" : "NOT all invariants hold.\n");
}

std::string to_text(const VerifyReport& report) {
  std::string text;
  const Buffer out = std::back_inserter(text);
  print_errors(report, out);
  print_seams(report, out);
  print_morphs(report, out);
  print_listing(report, out);
  print_water(report, out);
  return text + verdict_text(report.problems, report.problems_left_out, report.holds());
}

std::string to_json(const VerifyReport& report) {
  Json object = {{"holds", report.holds()}, {"levels", Json::array()}};
  for (const LevelReport& level : report.levels) object["levels"].push_back(to_json(level));
  object["samples_under_water"] = report.samples_under_water;
  object["water_samples_wrong"] = report.water_samples_wrong;
  object["problems"] = report.problems;
  object["problems_left_out"] = report.problems_left_out;
  return object.dump(2) + "\n";
}

}  // namespace terrane::verify

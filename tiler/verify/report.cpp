#include "tiler/verify/report.h"

#include <algorithm>

namespace terrane::verify {

bool MorphReport::holds() const {
  return samples_over_tolerance == 0 && uncovered_samples == 0 && folded_triangles == 0;
}

bool LevelReport::holds() const {
  const std::int64_t faults[] = {
      uncovered_samples,        samples_over_tolerance,   folded_triangles,
      mismatched_same_level,    mismatched_across_levels, torn_edges,
      parent_triangles_missing, parent_triangles_extra,   root_morphs,
      uneven_water_triangles,   samples_on_wrong_side,    boxes_violated,
      nested_errors_violated,   stated_error_too_small,   tiles_missing,
      tiles_unexpected,         facts_misstated};
  return std::all_of(std::begin(faults), std::end(faults), [](auto n) { return n == 0; }) &&
         std::all_of(morph.begin(), morph.end(), [](const auto& m) { return m.holds(); });
}

bool VerifyReport::holds() const {
  return !levels.empty() && water_samples_wrong == 0 &&
         std::all_of(levels.begin(), levels.end(), [](const auto& level) { return level.holds(); });
}

}  // namespace terrane::verify

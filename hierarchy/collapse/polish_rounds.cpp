#include "hierarchy/collapse/polish_rounds.h"

namespace terrane::hierarchy {
namespace {

constexpr int kDefault = 1;

// by effort, at level 0 and above
constexpr PolishRounds kRounds[] = {{}, {0, 1}, {3, 0}, {40, 0}};
constexpr PolishRounds kRoundsAbove[] = {{}, {4, 1}, {4, 1}, {8, 0}};

// with the default effort, by samples per triangle: below the first, levels were within 6 % of a
// mesh without tiles as they were; between the others that takes most; beyond, a round costs all
// samples for few triangles, and in the end for next to none (docs/benchmarks.md)
constexpr double kFewSamples = 15, kManySamples = 30, kMostSamples = 250, kAllSamples = 1000;

}  // namespace

PolishRounds polish_rounds(int effort, bool is_above_level_0, double samples_per_triangle) {
  if (!is_above_level_0) return kRounds[effort];
  if (effort == kDefault &&
      (samples_per_triangle < kFewSamples || samples_per_triangle >= kAllSamples)) {
    return {};
  }
  const bool is_between =
      kManySamples <= samples_per_triangle && samples_per_triangle < kMostSamples;
  if (effort == kDefault && !is_between) return {1, 0};
  return kRoundsAbove[effort];
}

}  // namespace terrane::hierarchy

#include "hierarchy/collapse/polish_rounds.h"

namespace terrane::hierarchy {
namespace {

constexpr int kDefault = 1;

// by effort, at level 0 and above
constexpr PolishRounds kRounds[] = {{}, {0, 1}, {3, 0}, {40, 0}};
constexpr PolishRounds kRoundsAbove[] = {{}, {3, 1}, {3, 1}, {8, 0}};

// with the default effort: where levels were 6 % above a mesh without tiles (docs/benchmarks.md)
constexpr double kFewSamples = 15, kManySamples = 30;

}  // namespace

PolishRounds polish_rounds(int effort, bool is_above_level_0, double samples_per_triangle) {
  if (!is_above_level_0) return kRounds[effort];
  if (effort == kDefault && samples_per_triangle < kFewSamples) return {};
  if (effort == kDefault && samples_per_triangle < kManySamples) return {1, 0};
  return kRoundsAbove[effort];
}

}  // namespace terrane::hierarchy

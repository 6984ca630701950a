#include "hierarchy/collapse/polish_rounds.h"

#include <gtest/gtest.h>

namespace terrane::hierarchy {
namespace {

TEST(PolishRounds, NoEffortIsNoPolish) {
  for (const double samples : {1.0, 1e6}) {
    EXPECT_EQ(polish_rounds(0, false, samples), PolishRounds());
    EXPECT_EQ(polish_rounds(0, true, samples), PolishRounds());
  }
}

TEST(PolishRounds, LevelZeroIsPolishedNearSeamsAloneByDefault) {
  EXPECT_EQ(polish_rounds(1, false, 2).everywhere, 0);
  EXPECT_GT(polish_rounds(1, false, 2).near_locked, 0);
}

TEST(PolishRounds, ThereAreMoreWhereTrianglesAreFewOrEffortIsMore) {
  const auto all = [](PolishRounds rounds) { return rounds.everywhere + rounds.near_locked; };
  EXPECT_EQ(all(polish_rounds(1, true, 3)), 0);
  EXPECT_LE(all(polish_rounds(1, true, 20)), all(polish_rounds(1, true, 200)));
  EXPECT_LE(all(polish_rounds(1, true, 500)), all(polish_rounds(1, true, 200)));
  for (const bool is_above : {false, true}) {
    for (int effort = 0; effort < 3; ++effort) {
      EXPECT_LE(all(polish_rounds(effort, is_above, 200)),
                all(polish_rounds(effort + 1, is_above, 200)));
    }
  }
}

TEST(PolishRounds, ThereAreNoneByDefaultWhereTheyCostAllSamplesForAHandfulOfTriangles) {
  EXPECT_EQ(polish_rounds(1, true, 5000), PolishRounds());
  EXPECT_NE(polish_rounds(2, true, 5000), PolishRounds());
}

}  // namespace
}  // namespace terrane::hierarchy

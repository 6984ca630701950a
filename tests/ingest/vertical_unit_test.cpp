#include "ingest/vertical_unit.h"

#include <gtest/gtest.h>

namespace terrane::ingest {
namespace {

TEST(MetresPerUnit, HoldsTheLegalDefinitions) {
  EXPECT_EQ(metres_per_unit(VerticalUnit::kMetre), 1.0);
  EXPECT_EQ(metres_per_unit(VerticalUnit::kFoot), 0.3048);
  EXPECT_EQ(metres_per_unit(VerticalUnit::kUsSurveyFoot) * 3937, 1200.0);
}

TEST(ParseVerticalUnit, ReadsBackEveryName) {
  for (const auto unit : {VerticalUnit::kMetre, VerticalUnit::kFoot, VerticalUnit::kUsSurveyFoot}) {
    EXPECT_EQ(parse_vertical_unit(name_of(unit)), unit);
  }
}

TEST(ParseVerticalUnit, TakesNoOtherWord) {
  EXPECT_EQ(parse_vertical_unit("feet"), std::nullopt);
  EXPECT_EQ(parse_vertical_unit("Metre"), std::nullopt);
  EXPECT_EQ(parse_vertical_unit(""), std::nullopt);
}

TEST(RecogniseVerticalUnit, KnowsTheSpellingsOfFiles) {
  for (const char* word : {"m", "M", "metre", "Meters", " m "}) {
    EXPECT_EQ(recognise_vertical_unit(word), VerticalUnit::kMetre) << word;
  }
  for (const char* word : {"ft", "FEET", "foot", "International foot"}) {
    EXPECT_EQ(recognise_vertical_unit(word), VerticalUnit::kFoot) << word;
  }
  for (const char* word : {"us-ft", "ftUS", "US survey foot", "us_survey_feet", "Foot_US"}) {
    EXPECT_EQ(recognise_vertical_unit(word), VerticalUnit::kUsSurveyFoot) << word;
  }
}

TEST(RecogniseVerticalUnit, GuessesNothing) {
  for (const char* word : {"", "km", "cm", "fathom", "mm", "metric foot"}) {
    EXPECT_EQ(recognise_vertical_unit(word), std::nullopt) << word;
  }
}

TEST(RecogniseVerticalUnit, TellsTheTwoFeetApartByLength) {
  EXPECT_EQ(recognise_vertical_unit(0.3048), VerticalUnit::kFoot);
  EXPECT_EQ(recognise_vertical_unit(0.304800609601219), VerticalUnit::kUsSurveyFoot);
  EXPECT_EQ(recognise_vertical_unit(1.0), VerticalUnit::kMetre);
  EXPECT_EQ(recognise_vertical_unit(0.9144), std::nullopt);
}

}  // namespace
}  // namespace terrane::ingest

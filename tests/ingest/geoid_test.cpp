#include "ingest/geoid.h"

#include <gtest/gtest.h>

#include "core/errors.h"

namespace terrane::ingest {
namespace {

// the test points in the readme of EGM96 (NIMA, now NGA); ways to interpolate the 15' grid differ
// by some centimetres, and PROJ's is bilinear
TEST(Geoid, Egm96IsWherePublishedValuesAre) {
  const auto geoid = open_geoid("egm96");
  EXPECT_NEAR(geoid->undulation_m({269.7791550, 38.6281550}), -31.628, 0.1);
  EXPECT_NEAR(geoid->undulation_m({305.0211140, -14.6212170}), -2.969, 0.1);
  EXPECT_NEAR(geoid->undulation_m({102.4487290, 46.8743190}), -43.575, 0.1);
  EXPECT_NEAR(geoid->undulation_m({133.8747120, -23.6174460}), 15.871, 0.1);
  EXPECT_NEAR(geoid->undulation_m({359.9995, 38.6254730}), 50.066, 0.1);
  EXPECT_NEAR(geoid->undulation_m({0.0023, -0.4667440}), 17.329, 0.1);
}

TEST(Geoid, GoesRoundTheEarthWithoutAJump) {
  const auto geoid = open_geoid("egm96");
  EXPECT_NEAR(geoid->undulation_m({179.9999, 12}), geoid->undulation_m({-179.9999, 12}), 1e-3);
  EXPECT_NEAR(geoid->undulation_m({-0.0001, -40}), geoid->undulation_m({0.0001, -40}), 1e-3);
  EXPECT_EQ(geoid->undulation_m({-90, 20}), geoid->undulation_m({270, 20}));
}

TEST(Geoid, RefusesAnUnknownNameAndSaysWhatThereIs) {
  try {
    open_geoid("egm1066");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("--geoid egm1066"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("egm96"), std::string::npos);
  }
}

}  // namespace
}  // namespace terrane::ingest

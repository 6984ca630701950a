#include "ingest/height_conversion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <limits>

#include "core/errors.h"

namespace terrane::ingest {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(HeightConversion, AppliesScaleAndOffsetBeforeTheUnit) {
  const HeightConversion conversion{.scale = 0.5, .offset = 100, .metres_per_unit = 0.3048};
  EXPECT_EQ(conversion.height_m(2000), static_cast<float>(1100 * 0.3048));
}

TEST(HeightConversion, RoundsOnlyOnce) {
  // 16777217 = 2^24 + 1 is no float: rounding it before halving would lose the last bit
  const HeightConversion conversion{.scale = 1, .offset = -16777216};
  EXPECT_EQ(conversion.height_m(16777217.0), 1.0F);
}

TEST(HeightConversion, ComparesNodataBeforeTheScale) {
  const HeightConversion conversion{.scale = 0.1, .nodata = {-9999}};
  EXPECT_TRUE(std::isnan(conversion.height_m(-9999)));
  EXPECT_EQ(conversion.height_m(-99990), -9999.0F);
}

TEST(HeightConversion, TakesNoInfinityForAHeight) {
  const HeightConversion conversion;
  EXPECT_TRUE(std::isnan(conversion.height_m(std::numeric_limits<double>::infinity())));
  EXPECT_TRUE(std::isnan(conversion.height_m(-std::numeric_limits<double>::infinity())));
  EXPECT_TRUE(std::isnan(conversion.height_m(std::nan(""))));
  EXPECT_TRUE(std::isnan(conversion.height_m(1e300)));  // an infinity as float
}

TEST(HeightConversion, TakesAllSpellingsOfTheLowestFloatForOne) {
  const HeightConversion conversion{.nodata = {-3.4e38}};
  EXPECT_TRUE(std::isnan(conversion.height_m(-3.4028234663852886e38)));
  EXPECT_TRUE(std::isnan(conversion.height_m(-3.40282306074e38)));
  EXPECT_FALSE(std::isnan(conversion.height_m(-3.3e38)));
}

TEST(RoundedToFloat, BringsNumbersBeyondTheLargestFloatBack) {
  EXPECT_EQ(rounded_to_float(-3.4028235e38), -FLT_MAX);
  EXPECT_EQ(rounded_to_float(0.1), static_cast<double>(0.1F));
  EXPECT_TRUE(std::isnan(rounded_to_float(std::nan(""))));
}

TEST(ParseNodata, ReadsNumbersAndNone) {
  EXPECT_THAT(parse_nodata("-32767", "a.tif"), ElementsAre(-32767));
  EXPECT_THAT(parse_nodata("-9999,1e20", "a.tif"), ElementsAre(-9999, 1e20));
  EXPECT_THAT(parse_nodata("none", "a.tif"), IsEmpty());
}

TEST(ParseNodata, RefusesAnythingElse) {
  for (const char* text : {"", "void", "12m", "1,", ",1", "1,none"}) {
    EXPECT_THROW(parse_nodata(text, "a.tif"), ConfigError) << text;
  }
}

TEST(SuspectsOf, AreWhatTheValuesAreReadAs) {
  const auto suspects = suspects_of({.metres_per_unit = 0.3048, .nodata = {-9999}});
  ASSERT_EQ(suspects.size(), 3u);
  EXPECT_EQ(suspects[0].stored, "-32767");
  EXPECT_EQ(suspects[0].height_m, static_cast<float>(-32767 * 0.3048));
  EXPECT_EQ(suspects[1].stored, "-32768");
  EXPECT_EQ(suspects[2].stored, "-3.4e38");
  EXPECT_TRUE(suspects[2].and_everything_beyond);
}

}  // namespace
}  // namespace terrane::ingest

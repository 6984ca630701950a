#include "tiler/raster/height_colours.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace terrane::tiler {
namespace {

using Pixel = std::array<int, 3>;

Pixel pixel_of(float height_m, HeightEncoding encoding, double fill_m = 0) {
  const auto rgb = colours_of(std::array{height_m}, encoding, fill_m);
  EXPECT_EQ(rgb.size(), 3U);
  return {rgb[0], rgb[1], rgb[2]};
}

TEST(HeightColours, TerrainRgbIsAsMapboxPublishesIt) {
  EXPECT_EQ(pixel_of(-10000, HeightEncoding::kTerrainRgb), (Pixel{0, 0, 0}));
  EXPECT_EQ(pixel_of(0, HeightEncoding::kTerrainRgb), (Pixel{1, 134, 160}));
  EXPECT_EQ(pixel_of(0.1F, HeightEncoding::kTerrainRgb), (Pixel{1, 134, 161}));
}

TEST(HeightColours, TerrariumIsAsTheTerrainTilesPublishIt) {
  EXPECT_EQ(pixel_of(0, HeightEncoding::kTerrarium), (Pixel{128, 0, 0}));
  EXPECT_EQ(pixel_of(-32768, HeightEncoding::kTerrarium), (Pixel{0, 0, 0}));
  EXPECT_EQ(pixel_of(-0.5F, HeightEncoding::kTerrarium), (Pixel{127, 255, 128}));
  EXPECT_EQ(pixel_of(300.25F, HeightEncoding::kTerrarium), (Pixel{129, 44, 64}));
}

TEST(HeightColours, RoundsToTheNearestStep) {
  EXPECT_EQ(pixel_of(0.06F, HeightEncoding::kTerrainRgb), (Pixel{1, 134, 161}));
  EXPECT_EQ(pixel_of(0.04F, HeightEncoding::kTerrainRgb), (Pixel{1, 134, 160}));
}

TEST(HeightColours, NoDataIsTheFill) {
  const float nothing = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(pixel_of(nothing, HeightEncoding::kTerrarium, -0.5), (Pixel{127, 255, 128}));
}

TEST(HeightColours, ARangeEndsAtThreeFullBytes) {
  for (const HeightEncoding encoding : {HeightEncoding::kTerrarium, HeightEncoding::kTerrainRgb}) {
    const auto [low_m, high_m] = range_of(encoding);
    EXPECT_EQ(pixel_of(static_cast<float>(low_m), encoding), (Pixel{0, 0, 0}));
    EXPECT_EQ(pixel_of(static_cast<float>(high_m), encoding), (Pixel{255, 255, 255}));
  }
}

TEST(HeightColours, OnlyTwoWordsAreKnown) {
  EXPECT_EQ(height_encoding_of("terrarium"), HeightEncoding::kTerrarium);
  EXPECT_EQ(height_encoding_of("terrain-rgb"), HeightEncoding::kTerrainRgb);
  EXPECT_FALSE(height_encoding_of("mapbox"));
}

}  // namespace
}  // namespace terrane::tiler

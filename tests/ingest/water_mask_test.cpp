#include "ingest/water_mask.h"

#include <gtest/gtest.h>

#include "tests/ingest/small_raster.h"

namespace terrane::ingest {
namespace {

using testing::RasterFolder;

// a lake from 1 to 2 degrees east and 1 to 3 north
constexpr const char* kLake = R"({"type":"FeatureCollection","features":[{"type":"Feature",
  "properties":{},"geometry":{"type":"Polygon","coordinates":
  [[[1,1],[2,1],[2,3],[1,3],[1,1]]]}}]})";

class WaterMaskTest : public ::testing::Test {
 protected:
  RasterFolder folder_;
  std::shared_ptr<const WaterMask> mask_ =
      open_water_mask({folder_.write_text("lake.geojson", kLake)});
};

TEST_F(WaterMaskTest, RowsRunFromTheNorthAndColumnsFromTheWest) {
  const std::string mask = mask_->bytes(0, 0, 4, 4);
  ASSERT_EQ(mask.size(), 256U * 256U);
  const auto at = [&](double lon, double lat) {
    return static_cast<unsigned char>(
        mask[static_cast<std::size_t>((4 - lat) * 64) * 256 + static_cast<std::size_t>(lon * 64)]);
  };
  EXPECT_EQ(at(1.5, 2.5), 255);
  EXPECT_EQ(at(1.5, 0.5), 0);  // mirrored, it would be water
  EXPECT_EQ(at(1.5, 3.5), 0);
  EXPECT_EQ(at(2.5, 2.5), 0);
  EXPECT_EQ(std::count(mask.begin(), mask.end(), '\xff'), 64 * 128);
}

TEST_F(WaterMaskTest, IsToldFromThatOfAnotherShoreByItsFingerprint) {
  const auto mask_of = [this](const std::string& name, std::string text) {
    return open_water_mask({folder_.write_text(name, text)})->fingerprint();
  };
  EXPECT_EQ(mask_of("same.geojson", kLake), mask_->fingerprint());
  std::string moved = kLake;
  moved.replace(moved.find("[2,3]"), 5, "[2,4]");
  EXPECT_NE(mask_of("moved.geojson", moved), mask_->fingerprint());
}

TEST_F(WaterMaskTest, OneByteWhereAllIsTheSame) {
  EXPECT_EQ(mask_->bytes(10, 10, 11, 11), std::string(1, '\0'));
  EXPECT_EQ(mask_->bytes(1.2, 1.2, 1.4, 1.4), std::string(1, '\xff'));
}

}  // namespace
}  // namespace terrane::ingest

#include "archive/deflate.h"

#include <gtest/gtest.h>

namespace terrane::archive {
namespace {

std::string long_text() {
  std::string text;
  for (int i = 0; i < 30'000; ++i) text += "tile " + std::to_string(i * i) + "\n";
  return text;
}

TEST(Deflate, UnpacksToWhatWentIn) {
  for (const std::string& text : {std::string(), std::string("x"), long_text()}) {
    EXPECT_EQ(gunzip(gzip(text), 1 << 20), text);
    EXPECT_EQ(inflate_raw(deflate_raw(text), 1 << 20), text);
  }
}

TEST(Deflate, RefusesMoreThanItMayBecome) {
  const std::string text(100'000, 'a');
  EXPECT_EQ(gunzip(gzip(text), text.size()), text);
  EXPECT_EQ(gunzip(gzip(text), text.size() - 1), std::nullopt);
}

TEST(Deflate, RefusesWhatIsCutOffOrSpoiled) {
  const std::string good = gzip(long_text());
  EXPECT_EQ(gunzip(good.substr(0, good.size() - 1), 1 << 20), std::nullopt);
  EXPECT_EQ(gunzip(good.substr(0, 100), 1 << 20), std::nullopt);
  EXPECT_EQ(gunzip("", 1 << 20), std::nullopt);
  std::string spoiled = good;
  spoiled[good.size() / 2] ^= 1;
  EXPECT_EQ(gunzip(spoiled, 1 << 20), std::nullopt);
}

TEST(Crc32, IsThatOfTheStandard) {
  EXPECT_EQ(crc32_of("123456789"), 0xCBF43926u);  // the check value that catalogues give
}

}  // namespace
}  // namespace terrane::archive

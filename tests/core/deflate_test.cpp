#include "core/deflate/deflate.h"

#include <gtest/gtest.h>

namespace terrane {
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

TEST(Deflate, HoldsNoTimeAndNoName) {
  // RFC 1952, section 2.3: magic number, deflate, no flags, a time of zero
  EXPECT_EQ(gzip("terrane").substr(0, 8), std::string("\x1f\x8b\x08\0\0\0\0\0", 8));
}

TEST(Deflate, LevelsTradeBytesForTime) {
  EXPECT_LT(gzip(long_text()).size(), gzip(long_text(), 1).size());
  EXPECT_EQ(gunzip(gzip(long_text(), 1), 1 << 20), long_text());
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
}  // namespace terrane

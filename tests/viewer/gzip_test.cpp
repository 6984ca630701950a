#include "viewer/server/gzip.h"

#include <gtest/gtest.h>

#include "tests/viewer/gunzip.h"

namespace terrane::viewer {
namespace {

TEST(Gzip, UnpacksToWhatWentIn) {
  std::string content;
  for (int i = 0; i < 20'000; ++i) content += "tile " + std::to_string(i * i) + "\n";
  const std::string compressed = gzip(content);
  EXPECT_LT(compressed.size(), content.size() / 2);
  EXPECT_EQ(testing::gunzip(compressed, content.size()), content);
}

TEST(Gzip, HoldsNoTimeAndNoName) {
  const std::string compressed = gzip("terrane");
  // RFC 1952, section 2.3: magic number, deflate, no flags, a time of zero
  EXPECT_EQ(compressed.substr(0, 8), std::string("\x1f\x8b\x08\0\0\0\0\0", 8));
}

}  // namespace
}  // namespace terrane::viewer

#include "viewer/server/content_coding.h"

#include <gtest/gtest.h>

namespace terrane::viewer {
namespace {

TEST(AcceptsCoding, WhenItIsListedWithAnyWeightButZero) {
  for (const char* header : {"gzip", "gzip, deflate, br, zstd", "br;q=1.0, gzip;q=0.8, *;q=0.1",
                             "deflate ,  gzip", "gzip; q=0.001", "GZIP", "*", "br, *;q=0.1"}) {
    EXPECT_TRUE(accepts_coding(header, "gzip")) << header;
  }
}

TEST(AcceptsCoding, NotWhenItIsRefusedOrNotListed) {
  for (const char* header : {"", "identity", "br", "gzip;q=0", "gzip; q=0.000, br", "xgzip",
                             "gzip2", ",,", "*;q=0", "gzip;q=0, *"}) {
    EXPECT_FALSE(accepts_coding(header, "gzip")) << header;
  }
}

}  // namespace
}  // namespace terrane::viewer

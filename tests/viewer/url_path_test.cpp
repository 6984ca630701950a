#include "viewer/server/url_path.h"

#include <gtest/gtest.h>

namespace terrane::viewer {
namespace {

TEST(DecodeUrlPath, DecodesOnceAndDropsTheQuery) {
  EXPECT_EQ(decode_url_path("/a%20b/c.glb?x=%2e"), "/a b/c.glb");
  EXPECT_EQ(decode_url_path("/%252e%252e/x"), "/%2e%2e/x");
  EXPECT_EQ(decode_url_path("http://host:80/a"), "/a");
  EXPECT_EQ(decode_url_path("http://host"), "/");
  EXPECT_EQ(decode_url_path("/a#b"), "/a");
  EXPECT_EQ(decode_url_path("/%00"), std::string("/\0", 2));
}

TEST(DecodeUrlPath, RefusesBrokenEscapesAndWhatIsNoPath) {
  for (const char* target : {"", "*", "a", "/%", "/%2", "/%zz", "/a%2", "ftp://host/a", "?x"}) {
    EXPECT_FALSE(decode_url_path(target)) << target;
  }
}

TEST(EncodeUrlPath, ComesBackAsItWas) {
  const std::string path = "/Lac L\xc3\xa9man & \"co\"/100%/a?b#c.glb";
  const std::string encoded = encode_url_path(path);
  EXPECT_EQ(encoded.find_first_of(" \"?#&"), std::string::npos);
  EXPECT_EQ(decode_url_path(encoded), path);
}

}  // namespace
}  // namespace terrane::viewer

#include "viewer/server/gzip_cache.h"

#include <gtest/gtest.h>

namespace terrane::viewer {
namespace {

class Counted {
 public:
  std::string get(GzipCache& cache, const std::string& key) {
    return *cache.get(key, [&] {
      ++made_;
      return key + key;
    });
  }
  int made() const { return made_; }

 private:
  int made_ = 0;
};

TEST(GzipCache, MakesATextOnce) {
  GzipCache cache(100);
  Counted texts;
  EXPECT_EQ(texts.get(cache, "a"), "aa");
  EXPECT_EQ(texts.get(cache, "a"), "aa");
  EXPECT_EQ(texts.made(), 1);
}

TEST(GzipCache, ForgetsWhatWasNotUsedForLongest) {
  GzipCache cache(4);
  Counted texts;
  for (const char* key : {"a", "b", "a", "c"}) texts.get(cache, key);  // c takes the place of b
  EXPECT_EQ(texts.made(), 3);
  texts.get(cache, "a");
  EXPECT_EQ(texts.made(), 3);
  texts.get(cache, "b");
  EXPECT_EQ(texts.made(), 4);
}

TEST(GzipCache, DoesNotKeepWhatIsTooLarge) {
  GzipCache cache(4);
  Counted texts;
  EXPECT_EQ(texts.get(cache, "long"), "longlong");
  EXPECT_EQ(texts.get(cache, "long"), "longlong");
  EXPECT_EQ(texts.made(), 2);
}

}  // namespace
}  // namespace terrane::viewer

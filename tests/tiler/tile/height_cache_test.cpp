#include "tiler/tile/height_cache.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <random>
#include <thread>

#include "tests/tiler/test_dem.h"

namespace terrane::tiler {
namespace {

using testing::FunctionDem;

/// Counts the samples that are read from it.
class CountedDem final : public HeightSource {
 public:
  GridShape shape() const override { return {700, 530}; }
  HeightGrid read(const Window& window) const override {
    samples_read += window.columns * window.rows;
    return dem_.read(window);
  }

  mutable std::atomic<std::int64_t> samples_read = 0;

 private:
  FunctionDem dem_{{700, 530}, [](std::int64_t column, std::int64_t row) {
                     return column % 13 == 5 ? NAN : static_cast<double>(column * 1000 + row);
                   }};
};

bool is_same(const HeightGrid& a, const HeightGrid& b) {
  if (a.window != b.window || a.heights_m.size() != b.heights_m.size()) return false;
  for (std::size_t k = 0; k < a.heights_m.size(); ++k) {
    const bool both_void = std::isnan(a.heights_m[k]) && std::isnan(b.heights_m[k]);
    if (!both_void && a.heights_m[k] != b.heights_m[k]) return false;
  }
  return true;
}

/// Windows of all sizes, anywhere.
void expect_heights_of(const CountedDem& dem, const HeightSource& cache, unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&](std::int64_t end) {
    return std::uniform_int_distribution<std::int64_t>(0, end - 1)(random);
  };
  for (int k = 0; k < 60; ++k) {
    const std::int64_t column = below(700), row = below(530);
    const Window window{column, row, 1 + below(700 - column), 1 + below(530 - row)};
    EXPECT_TRUE(is_same(cache.read(window), dem.read(window)));
  }
}

TEST(HeightCache, GivesTheHeightsOfItsSource) {
  const CountedDem dem;
  const HeightCache cache(dem, 1'000'000);
  EXPECT_EQ(cache.shape(), dem.shape());
  expect_heights_of(dem, cache, 1);
}

TEST(HeightCache, GivesThemThoughItMayKeepLessThanIsAskedForAtOnce) {
  const CountedDem dem;
  const HeightCache cache(dem, 1);
  expect_heights_of(dem, cache, 2);
}

TEST(HeightCache, ReadsEachSampleOnceIfAllFit) {
  const CountedDem dem;
  const HeightCache cache(dem, 1'000'000);
  for (int times = 0; times < 3; ++times) cache.read({0, 0, 700, 530});
  EXPECT_EQ(dem.samples_read, 700 * 530);
}

TEST(HeightCache, ForgetsWhatWasNotAskedForLongest) {
  const CountedDem dem;
  const HeightCache cache(dem, std::int64_t{2} * 256 * 256);
  const Window first{0, 0, 9, 9}, second{300, 0, 9, 9}, third{0, 300, 9, 9};
  cache.read(first);
  cache.read(second);
  cache.read(first);
  cache.read(third);
  const std::int64_t before = dem.samples_read;
  cache.read(first);
  EXPECT_EQ(dem.samples_read, before);
  cache.read(second);
  EXPECT_GT(dem.samples_read, before);
}

TEST(HeightCache, GivesThemToManyThreads) {
  const CountedDem dem;
  const HeightCache cache(dem, std::int64_t{3} * 256 * 256);
  std::vector<std::thread> threads;
  for (unsigned k = 0; k < 8; ++k) {
    threads.emplace_back([&, k] { expect_heights_of(dem, cache, k); });
  }
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace terrane::tiler

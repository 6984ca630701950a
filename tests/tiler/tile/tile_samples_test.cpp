#include "tiler/tile/tile_samples.h"

#include <gtest/gtest.h>

#include <mutex>
#include <set>

#include "tests/tiler/test_dem.h"

namespace terrane::tiler {
namespace {

using testing::FunctionDem;

double height(std::int64_t column, std::int64_t row) {
  return static_cast<double>(column % 100) + 100 * static_cast<double>(row % 50);
}

TEST(TileSamples, FewAreOnePatchAndAllAreKept) {
  const FunctionDem dem({200, 100}, height);
  const TileSamples samples(dem, {64, 0, 65, 65}, 1, 1000);
  EXPECT_EQ(samples.patch_count(), 1U);
  EXPECT_EQ(samples.block_cells(), 1);
  EXPECT_EQ(samples.whole().window, (Window{63, 0, 67, 66}));
}

TEST(TileSamples, ManyComeInPatchesThatCoverEachSampleOnce) {
  const FunctionDem dem({9000, 700}, height);
  const Window window{10, 20, 8193, 600};
  const TileSamples samples(dem, window, 2, 10);
  ASSERT_GT(samples.patch_count(), 1U);

  std::mutex mutex;
  std::vector<int> times(static_cast<std::size_t>(window.columns * window.rows), 0);
  samples.for_each_patch([&](std::size_t k, const Window& patch, const HeightGrid& grid) {
    const std::scoped_lock lock(mutex);
    for (std::int64_t row = patch.row; row < patch.row + patch.rows; ++row) {
      for (std::int64_t column = patch.column; column < patch.column + patch.columns; ++column) {
        ++times[static_cast<std::size_t>((row - window.row) * window.columns + column -
                                         window.column)];
      }
    }
    EXPECT_EQ(samples.patch_of(patch.column, patch.row), k);
    EXPECT_EQ(grid.at(patch.column - 2, patch.row - 2), height(patch.column - 2, patch.row - 2));
  });
  EXPECT_EQ(std::set<int>(times.begin(), times.end()), std::set<int>{1});
}

TEST(TileSamples, HeightsAreThoseOfTheDemWhicheverPatchTheyAreIn) {
  const FunctionDem dem({9000, 700}, height);
  const TileSamples samples(dem, {0, 0, 9000, 700}, 0, 10);
  const std::vector<hierarchy::SampleId> asked{{8999, 699}, {0, 0}, {4321, 65}, {4321, 63}};
  const std::vector<double> found = samples.heights_m(asked);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    EXPECT_EQ(found[i], height(asked[i].column, asked[i].row));
  }
}

TEST(TileSamples, BlocksGrowUntilWhatIsKeptFitsButLeaveSixSamplesToATriangle) {
  const FunctionDem dem({1 << 14, 1 << 14}, height);
  const Window window{0, 0, 1 << 13, 1 << 13};
  const TileSamples coarse(dem, window, 0, 1000);
  const double samples = 67'108'864;
  const auto kept = [&](const TileSamples& s) {
    return 10 * samples / static_cast<double>(s.block_cells() * s.block_cells());
  };
  EXPECT_LE(kept(coarse), 4.5e6);
  EXPECT_GT(4 * kept(coarse), 4.5e6);
  const TileSamples dense(dem, window, 0, 2'000'000);
  EXPECT_LT(dense.block_cells(), coarse.block_cells());
}

class NoLooseSamples : public LooseSamples {
 public:
  std::vector<LooseSample> in(const Window&) const override { return {}; }
};

TEST(TileSamples, WhereAllStayBehindThemFewerAreKept) {
  const FunctionDem dem({1 << 11, 1 << 11}, height);
  const Window window{0, 0, 2000, 2000};
  const NoLooseSamples none;
  EXPECT_EQ(TileSamples(dem, window, 0, 1000).block_cells(), 1);
  // a tenth of the samples, and a hundred to a triangle
  EXPECT_EQ(TileSamples(dem, window, 0, 1000, nullptr, Behind::kAllSamples).block_cells(), 16);
  EXPECT_EQ(TileSamples(dem, window, 0, 10'000, nullptr, Behind::kAllSamples).block_cells(), 8);
  EXPECT_EQ(TileSamples(dem, window, 0, 40'000, nullptr, Behind::kAllSamples).block_cells(), 1);
  // loose samples do not stay
  EXPECT_EQ(TileSamples(dem, window, 0, 1000, &none, Behind::kAllSamples).block_cells(), 1);
}

}  // namespace
}  // namespace terrane::tiler

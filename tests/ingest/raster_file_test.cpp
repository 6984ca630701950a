#include "ingest/raster_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <thread>

#include "small_raster.h"

namespace terrane::ingest {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::input_error_of;
using testing::RasterFolder;
using testing::SmallRaster;

// tiles of 16 x 16 under windows of other sizes
SmallRaster hills() {
  return {.columns = 101,
          .rows = 67,
          .value = [](int c, int r) { return c % 7 == 3 && r % 5 == 2 ? -9999 : 0.1 * c * r; },
          .nodata = -9999,
          .unit = "ft",
          .creation_options = {"TILED=YES", "BLOCKXSIZE=16", "BLOCKYSIZE=16", "COMPRESS=DEFLATE"}};
}

bool is_same_bits(const HeightGrid& part, const HeightGrid& whole) {
  const Window& window = part.window;
  for (std::int64_t r = 0; r < window.rows; ++r) {
    const auto first =
        static_cast<std::size_t>((window.row + r) * whole.window.columns + window.column);
    if (std::memcmp(&part.heights_m[static_cast<std::size_t>(r * window.columns)],
                    &whole.heights_m[first],
                    static_cast<std::size_t>(window.columns) * sizeof(float)) != 0) {
      return false;
    }
  }
  return true;
}

TEST(RasterFile, GivesTheSameBitsThroughEveryWindow) {
  const RasterFolder folder;
  const RasterFile file(folder.write("hills.tif", hills()), {});
  const HeightGrid whole = file.read({0, 0, 101, 67});
  EXPECT_EQ(whole.at(10, 20), static_cast<float>(static_cast<double>(20.0F) * 0.3048));
  EXPECT_FALSE(whole.has_data(10, 2));
  for (std::int64_t size = 1; size <= 40; size += 13) {
    for (std::int64_t row = 0; row + size <= 67; row += 9) {
      for (std::int64_t column = 0; column + size <= 101; column += 11) {
        EXPECT_TRUE(is_same_bits(file.read({column, row, size, size}), whole));
      }
    }
  }
}

TEST(RasterFile, GivesTheSameBitsToManyThreads) {
  const RasterFolder folder;
  const RasterFile file(folder.write("hills.tif", hills()), {});
  const HeightGrid whole = file.read({0, 0, 101, 67});
  std::vector<int> differences(8);
  std::vector<std::jthread> threads;
  for (std::size_t t = 0; t < differences.size(); ++t) {
    threads.emplace_back([&, t] {
      for (std::int64_t i = 0; i < 200; ++i) {
        const Window window{(i * 13 + std::ssize(differences)) % 80, (i * 7) % 50, 17, 15};
        if (!is_same_bits(file.read(window), whole)) ++differences[t];
        if (i % 50 == 0) file.close();
      }
    });
  }
  threads.clear();
  EXPECT_THAT(differences, ::testing::Each(0));
}

TEST(RasterFile, OpensAgainAfterClose) {
  const RasterFolder folder;
  const RasterFile file(folder.write("hills.tif", hills()), {});
  const HeightGrid before = file.read({0, 0, 101, 67});
  file.close();
  EXPECT_TRUE(is_same_bits(file.read({0, 0, 101, 67}), before));
}

TEST(RasterFile, NamesTheWindowThatATruncatedFileCannotGive) {
  const RasterFolder folder;
  const std::string path = folder.write("cut.tif", {.columns = 100, .rows = 400});
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  const RasterFile file(path, {});
  EXPECT_EQ(file.read({0, 0, 100, 10}).at(5, 1), 105.0F);
  EXPECT_THAT(input_error_of([&] {
                file.read({20, 350, 30, 40});
              }),
              AllOf(HasSubstr("cut.tif: cannot read columns 20 to 49, rows 350 to 389"),
                    HasSubstr("cut short")));
}

}  // namespace
}  // namespace terrane::ingest

#include "ingest/height_dataset.h"

#include <algorithm>
#include <limits>

#include "core/errors.h"

namespace terrane::ingest {

class HeightDataset::Band final : public GDALRasterBand {
 public:
  Band(HeightDataset& dataset, const HeightSource& heights) : heights_(heights), owner_(dataset) {
    constexpr int kBlock = 512;
    poDS = &dataset;
    nBand = 1;
    eDataType = GDT_Float32;
    nBlockXSize = std::min(dataset.GetRasterXSize(), kBlock);
    nBlockYSize = std::min(dataset.GetRasterYSize(), kBlock);
  }

  double GetNoDataValue(int* has_one) override {
    if (has_one != nullptr) *has_one = 1;
    return std::numeric_limits<double>::quiet_NaN();
  }

  CPLErr IReadBlock(int block_x, int block_y, void* data) override {
    auto* block = static_cast<float*>(data);
    const std::int64_t left = std::int64_t{block_x} * nBlockXSize - owner_.first_column();
    const std::int64_t top = std::int64_t{block_y} * nBlockYSize;
    const GridShape shape = heights_.shape();
    const std::int64_t rows = std::min<std::int64_t>(nBlockYSize, shape.rows - top);
    std::fill_n(block, static_cast<std::size_t>(nBlockXSize) * nBlockYSize, kNoHeight);
    try {
      // at most three pieces: what wraps round on the left, the middle, what wraps on the right
      for (std::int64_t column = left; column < left + nBlockXSize;) {
        const std::int64_t from = (column % shape.columns + shape.columns) % shape.columns;
        const std::int64_t count = std::min(left + nBlockXSize - column, shape.columns - from);
        const bool is_inside = column >= 0 && column < shape.columns;
        if (is_inside || owner_.goes_round_) {
          const HeightGrid grid = heights_.read({from, top, count, rows});
          for (std::int64_t row = 0; row < rows; ++row) {
            std::copy_n(grid.heights_m.begin() + row * count, count,
                        block + row * nBlockXSize + (column - left));
          }
        }
        column += count;
      }
    } catch (const Error& error) {
      // GDAL cannot carry an exception
      CPLError(CE_Failure, CPLE_FileIO, "%s", error.what());
      return CE_Failure;
    }
    return CE_None;
  }

 private:
  const HeightSource& heights_;
  const HeightDataset& owner_;
};

HeightDataset::HeightDataset(const HeightSource& heights, bool goes_round)
    : goes_round_(goes_round) {
  const GridShape shape = heights.shape();
  nRasterXSize = static_cast<int>(shape.columns) + (goes_round ? 2 * kMargin : 0);
  nRasterYSize = static_cast<int>(shape.rows);
  SetBand(1, new Band(*this, heights));  // the data set owns it
}

}  // namespace terrane::ingest

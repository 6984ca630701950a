#include "hierarchy/collapse/sample_field.h"

#include <numeric>

namespace terrane::hierarchy {

void SampleField::keep(std::int64_t block_side_cells, const std::vector<FieldSample>& samples) {
  block_cells = block_side_cells;
  heights_m = {};
  const auto block_of = [this](const FieldSample& sample) {
    const auto side = static_cast<std::size_t>(block_cells);
    // one that rounding left a little outside is of the block beside it
    const auto cell = [](float at) { return static_cast<std::size_t>(std::max(at, 0.0F)); };
    return cell(sample.row) / side * static_cast<std::size_t>(blocks().columns) +
           cell(sample.column) / side;
  };
  first_kept.assign(static_cast<std::size_t>(blocks().columns * blocks().rows) + 1, 0);
  for (const FieldSample& sample : samples) ++first_kept[block_of(sample) + 1];
  std::partial_sum(first_kept.begin(), first_kept.end(), first_kept.begin());
  std::vector<std::uint32_t> free(first_kept.begin(), first_kept.end() - 1);
  kept.resize(samples.size());
  for (const FieldSample& sample : samples) kept[free[block_of(sample)]++] = sample;
}

HeightSlabs SampleField::slabs_of_grid(std::int64_t side) const {
  HeightSlabs result({columns, rows}, side);
  for (std::int64_t first_row = 0; first_row < rows; first_row += side) {
    for (std::int64_t first = 0; first < columns; first += side) {
      const auto height_m = [&](std::int64_t c, std::int64_t r) {
        return is_reduced() ? behind.row(first + c, first_row + r)[0]
                            : row(first_row + r)[first + c];
      };
      result.at(first / side, first_row / side) = slab_around(
          std::min(side, columns - first), std::min(side, rows - first_row), side, height_m);
    }
  }
  return result;
}

}  // namespace terrane::hierarchy

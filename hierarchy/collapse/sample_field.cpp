#include "hierarchy/collapse/sample_field.h"

#include <algorithm>
#include <numeric>

#include "hierarchy/collapse/within_task.h"

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
  for_each_within_task(static_cast<std::size_t>((rows + side - 1) / side), [&](std::size_t k) {
    const auto block_row = static_cast<std::int64_t>(k);
    const std::int64_t top = block_row * side;
    for (std::int64_t left = 0; left < columns; left += side) {
      const auto height_m = [&](std::int64_t c, std::int64_t r) {
        return is_reduced() ? behind.row(left + c, top + r)[0] : row(top + r)[left + c];
      };
      result.at(left / side, block_row) =
          slab_around(std::min(side, columns - left), std::min(side, rows - top), side, height_m);
    }
  });
  return result;
}

}  // namespace terrane::hierarchy

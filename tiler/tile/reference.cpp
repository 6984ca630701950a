#include "tiler/tile/reference.h"

#include <algorithm>
#include <cmath>

#include "tiler/tile/datum_heights.h"
#include "tiler/tile/extremes.h"

namespace terrane::tiler {
namespace {

using hierarchy::FieldSample;

constexpr std::int64_t kBlockOfLoose_cells = 2;

// 272 MB
constexpr std::int64_t kMostSlabs = 17'000'000;

/// With many samples under a triangle, it pays to look at blocks of them first.
/// \return samples along a block; 1 where it does not pay.
std::int64_t paying_side(double samples_per_triangle) {
  if (samples_per_triangle > 2500) return 16;
  return samples_per_triangle > 600 ? 8 : 1;
}

bool is_before(const FieldSample& a, const FieldSample& b) {
  return std::pair(a.row, a.column) < std::pair(b.row, b.column);
}

bool is_same(const FieldSample& a, const FieldSample& b) {
  return a.row == b.row && a.column == b.column;
}

/// Calls collect(heights, patch, result) for each patch, and puts the results together in their
/// order.
template <class Collect>
std::vector<FieldSample> collect_by_patch(const TileSamples& samples, const TileFrame& frame,
                                          const Collect& collect) {
  std::vector<std::vector<FieldSample>> in_patch(samples.patch_count());
  samples.for_each_patch([&](std::size_t k, const Window& patch, const HeightGrid& grid) {
    collect(DatumHeights{grid, samples.window(), frame}, patch, in_patch[k]);
  });
  std::vector<FieldSample> result;
  for (const auto& part : in_patch) result.insert(result.end(), part.begin(), part.end());
  return result;
}

void add_all(const DatumHeights& heights, const Window& window, std::vector<FieldSample>& result) {
  heights.for_each(window, [&](double column, double row, double height_m) {
    result.push_back({static_cast<float>(column), static_cast<float>(row), height_m});
  });
}

/// Calls visit(patch, column, row, height) for every sample, patches at the same time; columns and
/// rows count from the tile's first. NaN where there is no height.
template <class Visit>
void for_each_sample_of(const TileSamples& samples, const TileFrame& frame, const Visit& visit) {
  const Window& tile = samples.window();
  samples.for_each_patch([&](std::size_t k, const Window& patch, const HeightGrid& grid) {
    const DatumHeights heights{grid, tile, frame};
    for (std::int64_t row = patch.row; row < patch.row + patch.rows; ++row) {
      for (std::int64_t column = patch.column; column < patch.column + patch.columns; ++column) {
        visit(k, column - tile.column, row - tile.row, heights.at(column, row));
      }
    }
  });
}

std::vector<double> all_heights_m(const TileSamples& samples, const TileFrame& frame) {
  const Window& tile = samples.window();
  std::vector<double> heights_m(static_cast<std::size_t>(tile.columns * tile.rows));
  for_each_sample_of(samples, frame,
                     [&](std::size_t, std::int64_t column, std::int64_t row, double height_m) {
                       heights_m[static_cast<std::size_t>(row * tile.columns + column)] = height_m;
                     });
  return heights_m;
}

hierarchy::CodedHeights coded_heights(const TileSamples& samples, const TileFrame& frame) {
  struct Range {
    double lowest_m = INFINITY, highest_m = -INFINITY;
  };
  std::vector<Range> ranges(samples.patch_count());
  for_each_sample_of(samples, frame,
                     [&](std::size_t patch, std::int64_t, std::int64_t, double height_m) {
                       // false for samples without a height
                       Range& range = ranges[patch];
                       if (height_m < range.lowest_m) range.lowest_m = height_m;
                       if (height_m > range.highest_m) range.highest_m = height_m;
                     });
  const Window& tile = samples.window();
  hierarchy::CodedHeights coded({tile.columns, tile.rows},
                                std::ranges::min(ranges, {}, &Range::lowest_m).lowest_m,
                                std::ranges::max(ranges, {}, &Range::highest_m).highest_m);
  for_each_sample_of(samples, frame,
                     [&](std::size_t, std::int64_t column, std::int64_t row, double height_m) {
                       coded.set(column, row, height_m);
                     });
  return coded;
}

/// Slabs of blocks so large that they fit the memory.
hierarchy::HeightSlabs slabs_of(const TileSamples& samples, const TileFrame& frame) {
  const Window& tile = samples.window();
  std::int64_t side = 2;
  while (tile.columns * tile.rows / (side * side) > kMostSlabs) side *= 2;
  hierarchy::HeightSlabs slabs({tile.columns, tile.rows}, side);
  samples.for_each_patch([&](std::size_t, const Window& patch, const HeightGrid& grid) {
    const DatumHeights heights{grid, tile, frame};
    for_each_part(patch, side, [&](const Window& block) {
      slabs.at((block.column - tile.column) / side, (block.row - tile.row) / side) =
          hierarchy::slab_around(block.columns, block.rows, side,
                                 [&](std::int64_t column, std::int64_t row) {
                                   return heights.at(block.column + column, block.row + row);
                                 });
    });
  });
  return slabs;
}

/// Grid samples and loose ones, all of them.
std::vector<FieldSample> all_samples(const TileSamples& samples, const TileFrame& frame) {
  std::vector<FieldSample> result = collect_by_patch(samples, frame, add_all);
  for (const LooseSample& loose : samples.loose_in(samples.window(), 0)) {
    result.push_back({static_cast<float>(loose.column), static_cast<float>(loose.row),
                      loose.height_m - frame.drop_m(loose.column, loose.row)});
  }
  return result;
}

std::vector<FieldSample> extremes_of_blocks(const TileSamples& samples, const TileFrame& frame) {
  const std::int64_t block_cells = samples.block_cells();
  return collect_by_patch(
      samples, frame,
      [&](const DatumHeights& heights, const Window& patch, std::vector<FieldSample>& result) {
        for_each_part(patch, TileSamples::kBlocksPerTrend * block_cells, [&](const Window& around) {
          add_extremes(heights, around, block_cells, result);
        });
      });
}

}  // namespace

Reference::Reference(const TileSamples& samples, const TileFrame& frame, double slack_cells,
                     std::int64_t most_in_memory) {
  const bool is_reduced = samples.block_cells() > 1;
  const std::int64_t all = samples.window().columns * samples.window().rows;
  const bool has_all = samples.behind() == Behind::kAllSamples;
  const bool is_backed = is_reduced && has_all;
  is_whole_ = !is_reduced || is_backed;
  field_ = {samples.window().columns, samples.window().rows, {}};
  if (is_reduced || samples.has_loose()) {
    kept_ = is_reduced ? extremes_of_blocks(samples, frame) : all_samples(samples, frame);
    field_.keep(std::max(samples.block_cells(), kBlockOfLoose_cells), kept_);
    if (is_backed && all <= most_in_memory) field_.behind = coded_heights(samples, frame);
    if (is_backed && all > most_in_memory) field_.slabs = slabs_of(samples, frame);
  } else {
    field_.heights_m = all_heights_m(samples, frame);
  }
  const std::int64_t side = paying_side(samples.samples_per_triangle());
  if (has_all && side > 1 && field_.has_grid()) field_.slabs = field_.slabs_of_grid(side);
  field_.slack_cells = slack_cells;
}

bool Reference::learn(const std::vector<FieldSample>& samples) {
  if (is_whole_) return false;
  const std::size_t before = kept_.size();
  kept_.insert(kept_.end(), samples.begin(), samples.end());
  std::ranges::sort(kept_, is_before);
  kept_.erase(std::unique(kept_.begin(), kept_.end(), is_same), kept_.end());
  field_.keep(field_.block_cells, kept_);
  return kept_.size() > before;
}

}  // namespace terrane::tiler

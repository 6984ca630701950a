#include "tiler/tile/tile_samples.h"

#include <algorithm>

#include "hierarchy/collapse/within_task.h"
#include "tiler/tile/extremes.h"

namespace terrane::tiler {
namespace {

// 8 MB of heights
constexpr std::int64_t kMostSamplesInPatch = std::int64_t{1} << 21;

// files are stored in rows or in blocks of about this many
constexpr std::int64_t kFewestRows = 64;

/// How many samples are kept in any case, and how many to each input triangle.
struct KeptSamples {
  double most, per_triangle;
};

// 150 MB; fewer left triangles of the finer level without a sample
constexpr KeptSamples kAlone{4.5e6, 6};

// fewer cost more than 1 % of the triangles (docs/benchmarks.md)
constexpr KeptSamples kBacked{4e5, 100};

std::int64_t fitting_block_cells(const Window& window, std::size_t input_triangles,
                                 const KeptSamples& kept_samples) {
  const double samples = static_cast<double>(window.columns) * static_cast<double>(window.rows);
  const double most =
      std::max(kept_samples.most, kept_samples.per_triangle * static_cast<double>(input_triangles));
  std::int64_t block = 1;
  for (double kept = samples; kept > most;) {
    block *= 2;
    kept = static_cast<double>(kExtremesPerPart) * samples / static_cast<double>(block * block);
  }
  return block;
}

Window widened(const Window& window, std::int64_t margin, const GridShape& shape) {
  const std::int64_t column = std::max<std::int64_t>(0, window.column - margin);
  const std::int64_t row = std::max<std::int64_t>(0, window.row - margin);
  return {column, row, std::min(shape.columns, window.column + window.columns + margin) - column,
          std::min(shape.rows, window.row + window.rows + margin) - row};
}

}  // namespace

TileSamples::TileSamples(const HeightSource& heights, const Window& window, std::int64_t margin,
                         std::size_t input_triangles, const LooseSamples* loose, Behind behind)
    : heights_(heights),
      loose_(loose),
      window_(window),
      margin_(margin),
      input_triangles_(input_triangles),
      behind_(loose == nullptr ? behind : Behind::kNothing),
      block_cells_(fitting_block_cells(window, input_triangles,
                                       behind_ == Behind::kAllSamples ? kBacked : kAlone)) {
  const std::int64_t trend_cells = kBlocksPerTrend * block_cells_;
  patch_columns_ = window_.columns;
  patch_rows_ = window_.rows;
  if (window_.columns * window_.rows > kMostSamplesInPatch) {
    patch_rows_ = std::max(kFewestRows, trend_cells);
    const std::int64_t fitting = kMostSamplesInPatch / patch_rows_ / trend_cells * trend_cells;
    patch_columns_ = std::min(window_.columns, std::max(trend_cells, fitting));
  }
  for (std::int64_t row = 0; row < window_.rows; row += patch_rows_) {
    for (std::int64_t column = 0; column < window_.columns; column += patch_columns_) {
      patches_.push_back({window_.column + column, window_.row + row,
                          std::min(patch_columns_, window_.columns - column),
                          std::min(patch_rows_, window_.rows - row)});
    }
  }
  patches_along_row_ = (window_.columns + patch_columns_ - 1) / patch_columns_;
  if (patch_count() == 1) whole_ = read(window_);
}

double TileSamples::samples_per_triangle() const {
  return static_cast<double>(window_.columns) * static_cast<double>(window_.rows) /
         static_cast<double>(std::max<std::size_t>(1, input_triangles_));
}

HeightGrid TileSamples::read(const Window& patch) const {
  return heights_.read(widened(patch, margin_, heights_.shape()));
}

void TileSamples::for_each_patch(
    const std::function<void(std::size_t, const Window&, const HeightGrid&)>& visit) const {
  if (whole_) {
    visit(0, patches_[0], *whole_);
    return;
  }
  hierarchy::for_each_within_task(patch_count(),
                                  [&](std::size_t k) { visit(k, patches_[k], read(patches_[k])); });
}

std::size_t TileSamples::patch_of(std::int64_t column, std::int64_t row) const {
  const auto along = [](std::int64_t at, std::int64_t first, std::int64_t count,
                        std::int64_t patch) {
    return std::clamp<std::int64_t>(at - first, 0, count - 1) / patch;
  };
  return static_cast<std::size_t>(along(row, window_.row, window_.rows, patch_rows_) *
                                      patches_along_row_ +
                                  along(column, window_.column, window_.columns, patch_columns_));
}

std::vector<LooseSample> TileSamples::loose_in(const Window& patch, std::int64_t margin) const {
  if (loose_ == nullptr) return {};
  std::vector<LooseSample> samples =
      loose_->in({patch.column - margin, patch.row - margin, patch.columns + 2 * margin,
                  patch.rows + 2 * margin});
  for (LooseSample& sample : samples) {
    sample.column -= static_cast<double>(window_.column);
    sample.row -= static_cast<double>(window_.row);
  }
  return samples;
}

std::vector<double> TileSamples::heights_m(std::span<const hierarchy::SampleId> samples) const {
  std::vector<std::vector<std::size_t>> in_patch(patch_count());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    in_patch[patch_of(samples[i].column, samples[i].row)].push_back(i);
  }
  std::vector<double> heights(samples.size());
  for_each_patch([&](std::size_t k, const Window&, const HeightGrid& grid) {
    for (const std::size_t i : in_patch[k]) {
      heights[i] = grid.at(samples[i].column, samples[i].row);
    }
  });
  return heights;
}

}  // namespace terrane::tiler

#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/height_grid.h"
#include "hierarchy/collapse/sample_field.h"
#include "tiler/tile/tile_frame.h"
#include "tiler/tile/tile_samples.h"

namespace terrane::tiler {

/// The samples of a patch, and where they stand in the world.
class MeasuredPatch {
 public:
  MeasuredPatch(const TileFrame& frame, const Window& tile, const Window& patch,
                const HeightGrid& grid)
      : window(patch),
        first_column(patch.column - tile.column),
        first_row(patch.row - tile.row),
        frame_(frame),
        grid_(grid) {
    for (std::int64_t row = 0; row < patch.rows; ++row) {
      rows_.push_back(frame.row(static_cast<double>(first_row + row)));
    }
  }

  /// Columns and rows count from the patch's first sample here.
  Plumb plumb(std::int64_t column, std::int64_t row) const {
    return rows_[static_cast<std::size_t>(row)].plumb(static_cast<double>(first_column + column));
  }
  double height_m(std::int64_t column, std::int64_t row) const {
    return grid_.at(window.column + column, window.row + row);
  }
  const TileFrame::Row& row(std::int64_t row) const { return rows_[static_cast<std::size_t>(row)]; }
  /// Heights of a row from some column on.
  const float* heights_m(std::int64_t column, std::int64_t row) const {
    const Window& of_grid = grid_.window;
    return grid_.heights_m.data() + (window.row + row - of_grid.row) * of_grid.columns +
           window.column + column - of_grid.column;
  }
  /// The k-th sample, row by row, for a SampleField of the tile.
  hierarchy::FieldSample sample(std::size_t k) const {
    const auto column = static_cast<std::int64_t>(k) % window.columns;
    const auto row = static_cast<std::int64_t>(k) / window.columns;
    const auto c = static_cast<double>(first_column + column);
    const auto r = static_cast<double>(first_row + row);
    return {static_cast<float>(c), static_cast<float>(r),
            height_m(column, row) - frame_.drop_m(c, r)};
  }
  hierarchy::FieldPoint local(const hierarchy::FieldPoint& tile_place) const {
    return {tile_place.column - static_cast<double>(first_column),
            tile_place.row - static_cast<double>(first_row), 0};
  }

  const Window window;
  const std::int64_t first_column, first_row;  // in the tile

 private:
  const TileFrame& frame_;
  const HeightGrid& grid_;
  std::vector<TileFrame::Row> rows_;
};

/// The loose samples of a patch, cell by cell, and where they stand in the world.
class LoosePatch {
 public:
  LoosePatch(const TileFrame& frame, const TileSamples& samples, const Window& patch)
      : first_column_(patch.column - samples.window().column - kMargin),
        first_row_(patch.row - samples.window().row - kMargin),
        cells_{patch.columns + 2 * kMargin, patch.rows + 2 * kMargin},
        samples_(samples.loose_in(patch, kMargin)) {
    std::ranges::stable_sort(samples_, {}, [&](const LooseSample& s) { return cell_of(s); });
    first_.assign(static_cast<std::size_t>(cells_.columns * cells_.rows) + 1, 0);
    for (const LooseSample& sample : samples_) {
      ++first_[static_cast<std::size_t>(cell_of(sample)) + 1];
      plumbs_.push_back(frame.plumb(sample.column, sample.row));
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
  }

  const std::vector<LooseSample>& samples() const { return samples_; }
  const Plumb& plumb(std::size_t k) const { return plumbs_[k]; }

  /// Calls visit(k) for the samples that may lie under a triangle.
  template <class Visit>
  void for_each_near(const hierarchy::FieldPoint& a, const hierarchy::FieldPoint& b,
                     const hierarchy::FieldPoint& c, double slack_cells, const Visit& visit) const {
    if (samples_.empty()) return;
    // a cell reaches to the next post
    for_each_span(local(a), local(b), local(c), cells_, 1 + slack_cells,
                  [&](std::int64_t row, std::int64_t first, std::int64_t last) {
                    const auto begin = static_cast<std::size_t>(row * cells_.columns + first);
                    const auto end = static_cast<std::size_t>(row * cells_.columns + last + 1);
                    for (std::size_t k = first_[begin]; k < first_[end]; ++k) visit(k);
                    return true;
                  });
  }

 private:
  // straight edges in the world lie beside the straight border over the grid: a neighbour's samples
  // may be under them
  static constexpr std::int64_t kMargin = 1;

  std::int64_t cell_of(const LooseSample& sample) const {
    const hierarchy::FieldPoint at = local({sample.column, sample.row, 0});
    return static_cast<std::int64_t>(at.row) * cells_.columns +
           static_cast<std::int64_t>(at.column);
  }
  hierarchy::FieldPoint local(const hierarchy::FieldPoint& tile_place) const {
    return {tile_place.column - static_cast<double>(first_column_),
            tile_place.row - static_cast<double>(first_row_), 0};
  }

  std::int64_t first_column_, first_row_;  // in the tile
  GridShape cells_;
  std::vector<LooseSample> samples_;  // by cell
  std::vector<Plumb> plumbs_;
  std::vector<std::size_t> first_;
};

}  // namespace terrane::tiler

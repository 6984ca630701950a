#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/height_grid.h"
#include "hierarchy/collapse/coded_heights.h"
#include "hierarchy/collapse/height_slabs.h"
#include "hierarchy/collapse/row_spans.h"
#include "hierarchy/mesh/grid_point.h"

namespace terrane::hierarchy {

/// One sample that a mesh is held against.
struct FieldSample {
  float column = 0;  ///< in cells
  float row = 0;
  double height_m = 0;  ///< NaN where there is none
};

/// What a mesh is held against: the samples of a tile, heights in metres over a datum that curves
/// with the Earth (so that a flat triangle is linear in it).
///
/// Where a tile has very many, some are kept, sorted into square blocks: a mesh near those is about
/// as near to all. Where all are behind them, what is near to those kept is held against all; else
/// whoever needs to be sure measures all of them afterwards.
struct SampleField {
  std::int64_t columns = 0;
  std::int64_t rows = 0;
  std::vector<double> heights_m;  ///< row by row, NaN for no data; empty if reduced
  /// Samples this near to a triangle, in cells, count as under it: by rounding, one on the outline
  /// may lie just outside. At least a little, as a sample on an edge is better met twice than
  /// never.
  double slack_cells = 1e-7;

  std::int64_t block_cells = 1;
  /// If reduced: those of block k, row by row of blocks, are kept[first_kept[k]] to
  /// kept[first_kept[k + 1] - 1].
  std::vector<FieldSample> kept = {};
  std::vector<std::uint32_t> first_kept = {};
  CodedHeights behind = {};  ///< if reduced: all samples, or none
  /// Of all samples, or none: with those it takes less time to hold large triangles against them,
  /// and where they are too many to be behind, it stands for them.
  HeightSlabs slabs = {};

  bool is_reduced() const { return block_cells > 1; }
  /// Is it reduced, and are all samples or their slabs behind it?
  bool is_backed() const { return is_reduced() && (!behind.empty() || !slabs.empty()); }
  /// Blocks along the columns and rows; the last may be smaller.
  GridShape blocks() const {
    return {(columns + block_cells - 1) / block_cells, (rows + block_cells - 1) / block_cells};
  }
  /// Are the samples of the grid there, all of them?
  bool has_grid() const { return !heights_m.empty() || !behind.empty(); }
  /// Samples that a mesh is held against in the end.
  std::size_t sample_count() const {
    return has_grid() || is_backed() ? static_cast<std::size_t>(columns * rows) : kept.size();
  }
  /// \param side  samples along a block.
  /// \pre has_grid()
  HeightSlabs slabs_of_grid(std::int64_t side) const;
  /// Reduces the field to some samples, none of them without a height; what is behind them stays.
  void keep(std::int64_t block_side_cells, const std::vector<FieldSample>& samples);

  const double* row(std::int64_t r) const {
    return heights_m.data() + static_cast<std::ptrdiff_t>(r * columns);
  }
};

/// Calls visit(number of the first sample, number after the last) for the samples of the blocks of
/// a reduced field that may lie between sides, row by row of blocks. Stops and returns false as
/// soon as visit does.
template <class Visit>
bool for_each_kept_run_between(std::span<const FieldSide> sides, const SampleField& field,
                               double slack_cells, Visit&& visit) {
  const std::int64_t row_of_blocks = field.blocks().columns;
  // half a block's diagonal takes in whatever lies in a block
  const double reach = 0.75 + slack_cells / static_cast<double>(field.block_cells);
  const SpansBetween blocks(sides, field.blocks(), reach, field.block_cells);
  return for_each_span_of(blocks, [&](std::int64_t row, std::int64_t first, std::int64_t last) {
    const auto begin = static_cast<std::size_t>(row * row_of_blocks + first);
    const auto end = static_cast<std::size_t>(row * row_of_blocks + last + 1);
    return visit(std::size_t{field.first_kept[begin]}, std::size_t{field.first_kept[end]});
  });
}

/// Calls visit(number of the sample, sample) for each sample of the field under the triangle or
/// nearer to it than \p slack_cells; numbers count from 0 over the whole field. Stops and returns
/// false as soon as visit does. Samples without data are left out.
template <class Visit>
bool for_each_sample(const FieldPoint& a, const FieldPoint& b, const FieldPoint& c,
                     const SampleField& field, double slack_cells, Visit&& visit) {
  if (!field.is_reduced()) {
    return for_each_span(a, b, c, {field.columns, field.rows}, slack_cells,
                         [&](std::int64_t row, std::int64_t first, std::int64_t last) {
                           const double* heights = field.row(row);
                           for (std::int64_t column = first; column <= last; ++column) {
                             if (std::isnan(heights[column])) continue;
                             if (!visit(static_cast<std::size_t>(row * field.columns + column),
                                        FieldSample{static_cast<float>(column),
                                                    static_cast<float>(row), heights[column]})) {
                               return false;
                             }
                           }
                           return true;
                         });
  }
  const auto reach = [&](const FieldPoint& p, const FieldPoint& q) {
    return slack_cells * std::hypot(q.column - p.column, q.row - p.row);
  };
  const auto beside = [](const FieldPoint& p, const FieldPoint& q, double column, double row) {
    return (q.row - p.row) * (column - p.column) - (q.column - p.column) * (row - p.row);
  };
  const double turn = beside(a, b, c.column, c.row) > 0 ? 1 : -1;
  const auto is_outside = [&](const FieldPoint& p, const FieldPoint& q, const FieldSample& s,
                              double nearest) {
    return turn * beside(p, q, s.column, s.row) < nearest;
  };
  const double ab = -reach(a, b), bc = -reach(b, c), ca = -reach(c, a);
  const FieldSide sides[] = {{&a, &b}, {&b, &c}, {&c, &a}};
  return for_each_kept_run_between(
      sides, field, slack_cells, [&](std::size_t first, std::size_t end) {
        for (std::size_t k = first; k < end; ++k) {
          const FieldSample& sample = field.kept[k];
          const bool is_beside = is_outside(a, b, sample, ab) || is_outside(b, c, sample, bc) ||
                                 is_outside(c, a, sample, ca);
          if (!is_beside && !visit(k, sample)) return false;
        }
        return true;
      });
}

/// Calls visit(samples) for runs of those samples of a reduced field that may lie in the convex
/// hull of 3 to 6 points. Stops and returns false as soon as visit does.
template <class Visit>
bool for_each_kept_run_of_hull(std::span<const FieldPoint> points, const SampleField& field,
                               double slack_cells, Visit&& visit) {
  const auto visit_run = [&](std::size_t first, std::size_t end) {
    return visit(std::span(field.kept).subspan(first, end - first));
  };
  return for_each_kept_run_between(HullSides(points).sides(), field, slack_cells, visit_run);
}

}  // namespace terrane::hierarchy

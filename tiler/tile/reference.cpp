#include "tiler/tile/reference.h"

#include <Eigen/Core>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>

namespace terrane::tiler {
namespace {

using hierarchy::FieldSample;
using hierarchy::SampleField;

bool is_before(const FieldSample& a, const FieldSample& b) {
  return std::pair(a.row, a.column) < std::pair(b.row, b.column);
}

bool is_same(const FieldSample& a, const FieldSample& b) {
  return a.row == b.row && a.column == b.column;
}

double height_over_datum(const HeightGrid& grid, const Window& tile, const TileFrame& frame,
                         std::int64_t column, std::int64_t row) {
  return grid.at(column, row) - frame.drop_m(static_cast<double>(column - tile.column),
                                             static_cast<double>(row - tile.row));
}

/// Sums for the least-squares trend.
class TrendPlane {
 public:
  void add(double x, double y, double z) {
    const Eigen::Vector3d terms(1, x, y);
    products_ += terms * terms.transpose();
    heights_ += z * terms;
  }

  /// Where fewer than three samples span a plane, one of those through them.
  Eigen::Vector3d solve() const {
    return products_.completeOrthogonalDecomposition().solve(heights_);
  }

 private:
  Eigen::Matrix3d products_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d heights_ = Eigen::Vector3d::Zero();
};

/// Calls visit(column, row, height over the datum) for the samples with data, counted from the
/// tile's first.
template <class Visit>
void for_each_height(const Window& window, const HeightGrid& grid, const Window& tile,
                     const TileFrame& frame, const Visit& visit) {
  for (std::int64_t row = window.row; row < window.row + window.rows; ++row) {
    for (std::int64_t column = window.column; column < window.column + window.columns; ++column) {
      if (!grid.has_data(column, row)) continue;
      visit(static_cast<double>(column - tile.column), static_cast<double>(row - tile.row),
            height_over_datum(grid, tile, frame, column, row));
    }
  }
}

/// Calls visit(part) for each square part of a window, the last ones cut off by it.
template <class Visit>
void for_each_part(const Window& window, std::int64_t side, const Visit& visit) {
  for (std::int64_t row = 0; row < window.rows; row += side) {
    for (std::int64_t column = 0; column < window.columns; column += side) {
      visit(Window{window.column + column, window.row + row,
                   std::min(side, window.columns - column), std::min(side, window.rows - row)});
    }
  }
}

/// A plane over some block, from a corner of its trend on.
struct Plane {
  double constant, per_column, per_row;
  double above_m(double x, double y, double z) const {
    return z - (constant + per_column * x + per_row * y);
  }
};

/// The trend, and the same tilted to each side as steeply as the terrain departs from it: whatever
/// plane a mesh has there, what sticks out most of it sticks out of one of these about as much.
class Trends {
 public:
  static constexpr std::size_t kCount = TileSamples::kExtremesPerBlock / 2;

  Trends(const Window& around, const HeightGrid& grid, const Window& tile, const TileFrame& frame)
      : x0_(static_cast<double>(around.column - tile.column)),
        y0_(static_cast<double>(around.row - tile.row)) {
    TrendPlane fitted;
    for_each_height(around, grid, tile, frame,
                    [&](double x, double y, double z) { fitted.add(x - x0_, y - y0_, z); });
    const Eigen::Vector3d terms = fitted.solve();
    const Plane trend{terms[0], terms[1], terms[2]};
    double highest_m = 0, lowest_m = 0;
    for_each_height(around, grid, tile, frame, [&](double x, double y, double z) {
      const double above_m = trend.above_m(x - x0_, y - y0_, z);
      highest_m = std::max(highest_m, above_m);
      lowest_m = std::min(lowest_m, above_m);
    });
    const double tilt =
        (highest_m - lowest_m) / static_cast<double>(std::max(around.columns, around.rows));
    constexpr double kSides[kCount][2] = {{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    for (std::size_t k = 0; k < kCount; ++k) {
      planes_[k] = trend;
      planes_[k].per_column += kSides[k][0] * tilt;
      planes_[k].per_row += kSides[k][1] * tilt;
    }
  }

  double above_m(std::size_t k, double x, double y, double z) const {
    return planes_[k].above_m(x - x0_, y - y0_, z);
  }

 private:
  double x0_, y0_;
  std::array<Plane, kCount> planes_;
};

/// A sample, and how far it sticks out.
struct Extreme {
  double by_m = -INFINITY;
  FieldSample sample;
};

/// Appends the extremes of the blocks of one trend.
void add_extremes(const Window& around, std::int64_t block_cells, const HeightGrid& grid,
                  const Window& tile, const TileFrame& frame, std::vector<FieldSample>& result) {
  const Trends trends(around, grid, tile, frame);
  for_each_part(around, block_cells, [&](const Window& block) {
    std::array<Extreme, TileSamples::kExtremesPerBlock> extremes;
    for_each_height(block, grid, tile, frame, [&](double x, double y, double z) {
      const FieldSample sample{static_cast<float>(x), static_cast<float>(y), z};
      for (std::size_t k = 0; k < Trends::kCount; ++k) {
        const double above_m = trends.above_m(k, x, y, z);
        if (above_m > extremes[2 * k].by_m) extremes[2 * k] = {above_m, sample};
        if (-above_m > extremes[2 * k + 1].by_m) extremes[2 * k + 1] = {-above_m, sample};
      }
    });
    if (extremes[0].by_m == -INFINITY) return;
    const auto first = static_cast<std::ptrdiff_t>(result.size());
    for (const Extreme& extreme : extremes) {
      const auto begin = result.begin() + first;
      if (std::none_of(begin, result.end(),
                       [&](const FieldSample& s) { return is_same(s, extreme.sample); })) {
        result.push_back(extreme.sample);
      }
    }
  });
}

SampleField full_field(const TileSamples& samples, const TileFrame& frame) {
  const Window& tile = samples.window();
  SampleField field{tile.columns, tile.rows, {}};
  field.heights_m.resize(static_cast<std::size_t>(tile.columns * tile.rows));
  samples.for_each_patch([&](std::size_t, const Window& patch, const HeightGrid& grid) {
    for (std::int64_t row = patch.row; row < patch.row + patch.rows; ++row) {
      const std::int64_t first = (row - tile.row) * tile.columns - tile.column;
      for (std::int64_t column = patch.column; column < patch.column + patch.columns; ++column) {
        field.heights_m[static_cast<std::size_t>(first + column)] =
            height_over_datum(grid, tile, frame, column, row);
      }
    }
  });
  return field;
}

/// Grid samples and loose ones, all of them.
std::vector<FieldSample> all_samples(const TileSamples& samples, const TileFrame& frame) {
  std::vector<std::vector<FieldSample>> in_patch(samples.patch_count());
  samples.for_each_patch([&](std::size_t k, const Window& patch, const HeightGrid& grid) {
    for_each_height(patch, grid, samples.window(), frame, [&](double column, double row, double z) {
      in_patch[k].push_back({static_cast<float>(column), static_cast<float>(row), z});
    });
  });
  std::vector<FieldSample> result;
  for (const auto& part : in_patch) result.insert(result.end(), part.begin(), part.end());
  for (const LooseSample& loose : samples.loose_in(samples.window(), 0)) {
    result.push_back({static_cast<float>(loose.column), static_cast<float>(loose.row),
                      loose.height_m - frame.drop_m(loose.column, loose.row)});
  }
  return result;
}

std::vector<FieldSample> extremes_of_blocks(const TileSamples& samples, const TileFrame& frame) {
  const std::int64_t block_cells = samples.block_cells();
  std::vector<std::vector<FieldSample>> in_patch(samples.patch_count());
  samples.for_each_patch([&](std::size_t k, const Window& patch, const HeightGrid& grid) {
    for_each_part(patch, TileSamples::kBlocksPerTrend * block_cells, [&](const Window& around) {
      add_extremes(around, block_cells, grid, samples.window(), frame, in_patch[k]);
    });
  });
  std::vector<FieldSample> result;
  for (const auto& part : in_patch) result.insert(result.end(), part.begin(), part.end());
  return result;
}

}  // namespace

Reference::Reference(const TileSamples& samples, const TileFrame& frame, double slack_cells,
                     std::int64_t most_in_memory) {
  const bool is_reduced = samples.block_cells() > 1;
  const std::int64_t all = samples.window().columns * samples.window().rows;
  is_whole_ = !is_reduced || (!samples.has_loose() && all <= most_in_memory);
  if (is_whole_ && !samples.has_loose()) {
    field_ = full_field(samples, frame);
  } else {
    field_ = {samples.window().columns, samples.window().rows, {}};
  }
  if (is_reduced || samples.has_loose()) {
    kept_ = is_reduced ? extremes_of_blocks(samples, frame) : all_samples(samples, frame);
    constexpr std::int64_t kBlockOfLoose_cells = 2;
    field_.keep(std::max(samples.block_cells(), kBlockOfLoose_cells), kept_);
  }
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

#include "tiler/verify/picture_heights.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "core/errors.h"

namespace terrane::verify {
namespace {

constexpr std::int64_t kStripRows = 64;
using Point = std::array<double, 2>;  // column and row, in pixels of the whole map

/// The corners of a cell on the map: north-west first, then along the row.
using Cell = std::array<Point, 4>;

/// Where in a cell a point lies, from 0 to 1 along columns and rows; none if outside.
///
/// Newton's way to the inverse of a bilinear map: cells are almost parallelograms.
std::optional<Point> place_in(const Cell& cell, const Point& at) {
  double s = 0.5, t = 0.5;
  const auto& [a, b, c, d] = cell;
  for (int round = 0; round < 8; ++round) {
    Point off{}, by_s{}, by_t{};
    for (std::size_t k = 0; k < 2; ++k) {
      off[k] = (1 - t) * ((1 - s) * a[k] + s * b[k]) + t * ((1 - s) * c[k] + s * d[k]) - at[k];
      by_s[k] = (1 - t) * (b[k] - a[k]) + t * (d[k] - c[k]);
      by_t[k] = (1 - s) * (c[k] - a[k]) + s * (d[k] - b[k]);
    }
    const double area = by_s[0] * by_t[1] - by_s[1] * by_t[0];
    if (area == 0) return std::nullopt;
    s -= (off[0] * by_t[1] - off[1] * by_t[0]) / area;
    t -= (by_s[0] * off[1] - by_s[1] * off[0]) / area;
  }
  if (!(s >= 0 && s < 1 && t >= 0 && t < 1)) return std::nullopt;
  return Point{s, t};
}

class Measurement {
 public:
  Measurement(const PictureSet& set, const HeightSource& heights, const Georeference& place)
      : set_(set), heights_(heights), place_(place), shape_(heights.shape()) {}

  void add_strip(std::int64_t row) {
    const std::int64_t rows = std::min(kStripRows, shape_.rows - 1 - row);
    place_strip(row, rows + 1);
    // samples beside the strip count as being around its pixels
    const std::int64_t first = std::max<std::int64_t>(0, row - reach_);
    const std::int64_t last = std::min(shape_.rows, row + rows + 1 + reach_);
    grid_ = heights_.read({0, first, shape_.columns, last - first});
    std::map<PictureKey, std::vector<double>> before = std::move(tiles_);
    tiles_.clear();
    before_ = &before;
    for (std::int64_t r = row; r < row + rows; ++r) {
      for (std::int64_t c = 0; c + 1 < shape_.columns; ++c) add_cell(c, r, r - row);
    }
    before_ = nullptr;
  }

  PictureErrors take() { return std::move(errors_); }

  /// How far around a cell samples count, in cells: those that a pixel of several cells covers.
  void find_reach() {
    constexpr std::int64_t kMost = 64;
    const std::int64_t c = (shape_.columns - 1) / 2, r = (shape_.rows - 1) / 2;
    const std::vector<Point> at =
        on_map(std::vector<GridPosition>{{static_cast<double>(c), static_cast<double>(r)},
                                         {static_cast<double>(c) + 1, static_cast<double>(r)},
                                         {static_cast<double>(c), static_cast<double>(r) + 1}});
    const auto length = [&](std::size_t k) {
      return std::hypot(at[k][0] - at[0][0], at[k][1] - at[0][1]);
    };
    const double cells = 1 / std::max(1e-9, std::min(length(1), length(2)));
    reach_ = std::clamp<std::int64_t>(static_cast<std::int64_t>(std::ceil(cells)) + 1, 1, kMost);
  }

 private:
  std::vector<Point> on_map(const std::vector<GridPosition>& positions) const {
    std::vector<Point> points;
    for (const LonLat& at : place_.to_lon_lat(positions)) {
      points.push_back(set_.on_map(at, set_.finest()));
    }
    return points;
  }

  void place_strip(std::int64_t row, std::int64_t rows) {
    std::vector<GridPosition> positions;
    for (std::int64_t r = row; r < row + rows; ++r) {
      for (std::int64_t c = 0; c < shape_.columns; ++c) {
        positions.push_back({static_cast<double>(c), static_cast<double>(r)});
      }
    }
    points_ = on_map(positions);
  }

  /// The corners of a cell next to each other, though it may lie across 180 degrees.
  Cell cell_at(std::int64_t column, std::int64_t strip_row) const {
    const auto at = [&](std::int64_t c, std::int64_t r) {
      return points_[static_cast<std::size_t>(r * shape_.columns + c)];
    };
    Cell cell{at(column, strip_row), at(column + 1, strip_row), at(column, strip_row + 1),
              at(column + 1, strip_row + 1)};
    const double across = set_.pixels_across(set_.finest());
    for (Point& corner : cell) {
      corner[0] = cell[0][0] + std::remainder(corner[0] - cell[0][0], across);
    }
    return cell;
  }

  void add_cell(std::int64_t column, std::int64_t row, std::int64_t strip_row) {
    const std::array<double, 4> corners{grid_.at(column, row), grid_.at(column + 1, row),
                                        grid_.at(column, row + 1), grid_.at(column + 1, row + 1)};
    if (std::ranges::any_of(corners, [](double height) { return std::isnan(height); })) return;
    const Cell cell = cell_at(column, strip_row);
    const auto bounds = [&](std::size_t axis) {
      const auto [low, high] =
          std::minmax({cell[0][axis], cell[1][axis], cell[2][axis], cell[3][axis]});
      // pixels whose middle is in between
      return std::array{static_cast<std::int64_t>(std::ceil(low - 0.5)),
                        static_cast<std::int64_t>(std::floor(high - 0.5))};
    };
    const auto [left, right] = bounds(0);
    const auto [top, bottom] = bounds(1);
    // the square ends at 85 degrees; beyond, cells grow without end
    const auto last = static_cast<std::int64_t>(set_.pixels_across(set_.finest())) - 1;
    for (std::int64_t y = std::max<std::int64_t>(top, 0); y <= std::min(bottom, last); ++y) {
      for (std::int64_t x = left; x <= right; ++x) {
        const auto in =
            place_in(cell, {static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5});
        if (!in) continue;
        const auto [s, t] = *in;
        add_pixel(x, y, column, row,
                  (1 - t) * ((1 - s) * corners[0] + s * corners[1]) +
                      t * ((1 - s) * corners[2] + s * corners[3]));
      }
    }
  }

  void add_pixel(std::int64_t x, std::int64_t y, std::int64_t column, std::int64_t row,
                 double bilinear_m) {
    const std::int64_t px = set_.tile_px;
    const auto across = static_cast<std::int64_t>(set_.pixels_across(set_.finest()));
    x = (x % across + across) % across;
    const PictureKey key{set_.finest(), x / px, y / px};
    const std::vector<double>& tile = tile_of(key);
    if (tile.empty()) return;  // missing or unreadable, which is said elsewhere
    const double height_m = tile[static_cast<std::size_t>((y % px) * px + x % px)];
    const double off_m = std::abs(height_m - bilinear_m);
    ++errors_.pixels;
    errors_.square_sum_m2 += off_m * off_m;
    errors_.max_m = std::max(errors_.max_m, off_m);
    const auto [low_m, high_m] = around(column, row);
    const double slack_m = set_.step_m() / 2 + kRounding_m;
    const double beyond_m = std::max(low_m - height_m, height_m - high_m) - slack_m;
    if (beyond_m <= 0) return;
    ++errors_.off;
    if (beyond_m <= farthest_m_) return;
    farthest_m_ = beyond_m;
    errors_.worst_place = fmt::format(
        "{}: pixel {}, {} is at {:.3f} m, the DEM around it at "
        "{:.3f} to {:.3f} m",
        to_string(key), x % px, y % px, height_m, low_m, high_m);
  }

  std::array<double, 2> around(std::int64_t column, std::int64_t row) const {
    double low_m = std::numeric_limits<double>::infinity(), high_m = -low_m;
    const Window& there = grid_.window;
    for (std::int64_t r = std::max(there.row, row - reach_);
         r <= std::min(there.row + there.rows - 1, row + 1 + reach_); ++r) {
      for (std::int64_t c = std::max<std::int64_t>(0, column - reach_);
           c <= std::min(shape_.columns - 1, column + 1 + reach_); ++c) {
        const double height_m = grid_.at(c, r);
        if (std::isnan(height_m)) continue;
        low_m = std::min(low_m, height_m);
        high_m = std::max(high_m, height_m);
      }
    }
    return {low_m, high_m};
  }

  /// Empty if it cannot be read.
  const std::vector<double>& tile_of(const PictureKey& key) {
    const auto found = tiles_.find(key);
    if (found != tiles_.end()) return found->second;
    std::vector<double> heights;
    if (const auto kept = before_->find(key); kept != before_->end()) {
      heights = std::move(kept->second);
    } else {
      try {
        const Picture picture = read_png(set_.file_of(key));
        if (picture.side_px == set_.tile_px) heights = set_.heights_of(picture);
      } catch (const InputError&) {
      }
    }
    return tiles_.emplace(key, std::move(heights)).first->second;
  }

  // floats of kilometres
  static constexpr double kRounding_m = 1e-3;

  const PictureSet& set_;
  const HeightSource& heights_;
  const Georeference& place_;
  GridShape shape_;
  std::int64_t reach_ = 1;
  std::vector<Point> points_;  // of the strip's samples
  HeightGrid grid_;            // the strip and what is around it
  std::map<PictureKey, std::vector<double>> tiles_;
  std::map<PictureKey, std::vector<double>>* before_ = nullptr;  // of the strip before
  double farthest_m_ = 0;
  PictureErrors errors_;
};

}  // namespace

PictureErrors measure_pictures(const PictureSet& set, const HeightSource& heights,
                               const Georeference& place, Progress& progress) {
  Measurement measurement(set, heights, place);
  measurement.find_reach();
  const std::int64_t rows = heights.shape().rows - 1;
  progress.begin("comparing with the DEM", (rows + kStripRows - 1) / kStripRows);
  for (std::int64_t row = 0; row < rows; row += kStripRows) {
    measurement.add_strip(row);
    progress.advance(1);
  }
  return measurement.take();
}

}  // namespace terrane::verify

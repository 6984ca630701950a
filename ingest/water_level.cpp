#include "ingest/water_level.h"

#include <algorithm>
#include <cmath>

namespace terrane::ingest {
namespace {

/// Rows first to last that a body reaches, and its columns.
struct Reach {
  std::int64_t first_row, last_row, first_column, last_column;
};

Reach reach_of(const WaterBody& body) {
  double top = INFINITY, bottom = -INFINITY, left = INFINITY, right = -INFINITY;
  for (const auto& shore : body.shores) {
    for (const GridPosition& p : shore) {
      top = std::min(top, p.row);
      bottom = std::max(bottom, p.row);
      left = std::min(left, p.column);
      right = std::max(right, p.column);
    }
  }
  return {static_cast<std::int64_t>(std::floor(top)), static_cast<std::int64_t>(std::ceil(bottom)),
          static_cast<std::int64_t>(std::floor(left)), static_cast<std::int64_t>(std::ceil(right))};
}

void add_span(std::vector<RowSpan>& spans, double from, double to) {
  const RowSpan span{static_cast<std::int64_t>(std::ceil(from)),
                     static_cast<std::int64_t>(std::floor(to))};
  if (span.first <= span.last) spans.push_back(span);
}

/// Spans that overlap or touch become one.
std::vector<RowSpan> joined(std::vector<RowSpan> spans) {
  std::ranges::sort(spans, {}, &RowSpan::first);
  std::vector<RowSpan> result;
  for (const RowSpan& span : spans) {
    if (!result.empty() && span.first <= result.back().last + 1) {
      result.back().last = std::max(result.back().last, span.last);
    } else {
      result.push_back(span);
    }
  }
  return result;
}

bool holds(const std::vector<RowSpan>& spans, std::int64_t column) {
  return std::ranges::any_of(
      spans, [column](const RowSpan& s) { return s.first <= column && column <= s.last; });
}

class LevelledWater final : public HeightSource {
 public:
  LevelledWater(std::unique_ptr<HeightSource> heights, WaterRows water)
      : heights_(std::move(heights)), rows_(std::move(water)) {}

  GridShape shape() const override { return heights_->shape(); }

  HeightGrid read(const Window& window) const override {
    HeightGrid grid = heights_->read(window);
    for (auto at = rows_.lower_bound(window.row);
         at != rows_.end() && at->first < window.row + window.rows; ++at) {
      for (const WaterSpan& span : at->second) {
        const std::int64_t first = std::max(span.first, window.column);
        const std::int64_t last = std::min(span.last, window.column + window.columns - 1);
        if (first > last) continue;
        const auto begin = grid.heights_m.begin() + (at->first - window.row) * window.columns;
        std::fill(begin + (first - window.column), begin + (last - window.column) + 1,
                  span.height_m);
      }
    }
    return grid;
  }

 private:
  std::unique_ptr<HeightSource> heights_;
  WaterRows rows_;
};

}  // namespace

std::vector<RowSpan> samples_inside(const WaterBody& body, std::int64_t row) {
  const auto r = static_cast<double>(row);
  std::vector<double> crossings;
  std::vector<RowSpan> spans;
  for (const auto& shore : body.shores) {
    for (std::size_t i = 0; i + 1 < shore.size(); ++i) {
      const GridPosition &a = shore[i], &b = shore[i + 1];
      if (a.row == r && b.row == r) {
        add_span(spans, std::min(a.column, b.column), std::max(a.column, b.column));
      } else if (a.row == r) {
        add_span(spans, a.column, a.column);
      }
      // a piece lies in one cell, so one that passes the row has an end on it
      if ((a.row <= r) != (b.row <= r)) crossings.push_back(a.row == r ? a.column : b.column);
    }
  }
  std::ranges::sort(crossings);
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
    add_span(spans, crossings[i], crossings[i + 1]);
  }
  return joined(std::move(spans));
}

std::optional<double> shore_height_m(const WaterBody& body, const HeightSource& heights) {
  const GridShape shape = heights.shape();
  Reach reach = reach_of(body);
  reach = {std::max<std::int64_t>(0, reach.first_row), std::min(shape.rows - 1, reach.last_row),
           std::max<std::int64_t>(0, reach.first_column),
           std::min(shape.columns - 1, reach.last_column)};
  if (reach.first_row > reach.last_row || reach.first_column > reach.last_column) return {};

  std::vector<float> on_shore, around;
  for (std::int64_t row = reach.first_row; row <= reach.last_row; ++row) {
    const HeightGrid line =
        heights.read({reach.first_column, row, reach.last_column - reach.first_column + 1, 1});
    const auto above = samples_inside(body, row - 1), inside = samples_inside(body, row),
               below = samples_inside(body, row + 1);
    for (std::int64_t column = reach.first_column; column <= reach.last_column; ++column) {
      const float height_m = line.at(column, row);
      if (std::isnan(height_m)) continue;
      around.push_back(height_m);
      if (!holds(inside, column)) continue;
      const bool is_surrounded = holds(inside, column - 1) && holds(inside, column + 1) &&
                                 holds(above, column) && holds(below, column);
      if (!is_surrounded) on_shore.push_back(height_m);
    }
  }
  std::vector<float>& known = on_shore.empty() ? around : on_shore;
  if (known.empty()) return {};
  const auto middle = known.begin() + static_cast<std::ptrdiff_t>((known.size() - 1) / 2);
  std::ranges::nth_element(known, middle);
  return *middle;
}

WaterRows water_rows(const std::vector<WaterBody>& bodies, const GridShape& shape) {
  WaterRows rows;
  for (const WaterBody& body : bodies) {
    const Reach reach = reach_of(body);
    for (std::int64_t row = std::max<std::int64_t>(0, reach.first_row);
         row <= std::min(reach.last_row, shape.rows - 1); ++row) {
      for (const RowSpan& span : samples_inside(body, row)) {
        rows[row].push_back({span.first, span.last, static_cast<float>(body.height_m)});
      }
    }
  }
  return rows;
}

std::unique_ptr<HeightSource> level_water(std::unique_ptr<HeightSource> heights, WaterRows water) {
  return std::make_unique<LevelledWater>(std::move(heights), std::move(water));
}

}  // namespace terrane::ingest

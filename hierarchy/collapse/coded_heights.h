#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/height_grid.h"

namespace terrane::hierarchy {

/// Heights of a grid in two bytes each, for grids of very many: rounded to 65,534 steps between the
/// lowest and the highest.
class CodedHeights {
 public:
  /// The code of a sample without a height.
  static constexpr std::uint16_t kNone = 0xFFFF;

  /// A row of them, from some column on.
  struct Row {
    const std::uint16_t* codes;
    double lowest_m, step_m;

    /// NaN where there is none.
    double operator[](std::size_t k) const {
      return codes[k] == kNone ? std::numeric_limits<double>::quiet_NaN()
                               : lowest_m + step_m * codes[k];
    }
  };

  CodedHeights() = default;
  /// A grid without heights yet, all of which will be between these two.
  CodedHeights(const GridShape& shape, double lowest_m, double highest_m)
      : columns_(shape.columns),
        lowest_m_(lowest_m),
        step_m_(std::max(highest_m - lowest_m, kLeastRange_m) / (kNone - 1)),
        codes_(static_cast<std::size_t>(shape.columns * shape.rows), kNone) {}

  bool empty() const { return codes_.empty(); }
  /// Most that a height is off by.
  double rounding_m() const { return step_m_ / 2; }

  /// \param height_m  NaN: none.
  void set(std::int64_t column, std::int64_t row, double height_m) {
    if (std::isnan(height_m)) return;
    codes_[number(column, row)] =
        static_cast<std::uint16_t>(std::lround((height_m - lowest_m_) / step_m_));
  }
  Row row(std::int64_t column, std::int64_t row) const {
    return {codes_.data() + number(column, row), lowest_m_, step_m_};
  }

 private:
  static constexpr double kLeastRange_m = 1e-3;

  std::size_t number(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>(row * columns_ + column);
  }

  std::int64_t columns_ = 0;
  double lowest_m_ = 0, step_m_ = 1;
  std::vector<std::uint16_t> codes_;
};

}  // namespace terrane::hierarchy

#include "hierarchy/collapse/feasible_heights.h"

#include <algorithm>

namespace terrane::hierarchy {
namespace {

// a sample that the centre moves less than that decides nothing
constexpr double kSmallestWeight = 1e-4;

constexpr double kIntervalMargin = 0.2;

}  // namespace

bool FeasibleHeights::add(const FieldPoint& centre, const FieldPoint& a, const FieldPoint& b) {
  const double ax = a.column - centre.column, ay = a.row - centre.row;
  const double bx = b.column - centre.column, by = b.row - centre.row;
  const double scale = 1 / (ax * by - ay * bx);
  return for_each_sample(
      centre, a, b, field_, field_.slack_cells, [&](std::size_t, const FieldSample& sample) {
        const double x = sample.column - centre.column, y = sample.row - centre.row;
        const double of_a = (x * by - y * bx) * scale, of_b = (ax * y - ay * x) * scale;
        const double weight = 1 - of_a - of_b;
        if (weight < kSmallestWeight) return true;
        const double rest_m = sample.height_m - of_a * a.height_m - of_b * b.height_m;
        lowest_m_ = std::max(lowest_m_, (rest_m - tolerance_m_) / weight);
        highest_m_ = std::min(highest_m_, (rest_m + tolerance_m_) / weight);
        weights_ += weight * weight;
        weighted_m_ += weight * rest_m;
        return lowest_m_ <= highest_m_;
      });
}

std::optional<double> FeasibleHeights::best_m() const {
  if (weights_ == 0) return std::nullopt;
  const double margin_m = kIntervalMargin * (highest_m_ - lowest_m_);
  return std::clamp(weighted_m_ / weights_, lowest_m_ + margin_m, highest_m_ - margin_m);
}

}  // namespace terrane::hierarchy

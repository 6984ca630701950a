#include "hierarchy/collapse/star_fit.h"

namespace terrane::hierarchy {
namespace {

// the fit leaves samples outside alone, where weights are negative: is_within() has the last word
constexpr double kOnEdge_cells = 1e-7;

/// value(column, row) of a function that is linear over a triangle.
struct Plane {
  double origin_column, origin_row, value, per_column, per_row;

  double at(double column, double row) const {
    return value + (column - origin_column) * per_column + (row - origin_row) * per_row;
  }
};

Plane plane_through(const FieldPoint& a, const FieldPoint& b, const FieldPoint& c) {
  const double bx = b.column - a.column, by = b.row - a.row, bz = b.height_m - a.height_m;
  const double cx = c.column - a.column, cy = c.row - a.row, cz = c.height_m - a.height_m;
  const double scale = 1 / (bx * cy - by * cx);
  return {a.column, a.row, a.height_m, (bz * cy - by * cz) * scale, (bx * cz - bz * cx) * scale};
}

/// Sums over the samples under a star whose centre has height z: the surface there is rest + w z.
struct Feasible {
  double lowest = -std::numeric_limits<double>::infinity();
  double highest = std::numeric_limits<double>::infinity();
  double ww = 0;  ///< sum of w^2
  double wd = 0;  ///< sum of w (sample - rest)
  double dd = 0;  ///< sum of (sample - rest)^2

  // below this weight the centre cannot mend what the fixed border of the star decides
  static constexpr double kSmallestWeight = 1e-9;

  bool add(double weight, double difference, double tolerance) {
    if (weight > kSmallestWeight) {
      const double scale = 1 / weight;
      lowest = std::max(lowest, (difference - tolerance) * scale);
      highest = std::min(highest, (difference + tolerance) * scale);
    } else if (std::abs(difference) > tolerance) {
      return false;
    }
    ww += weight * weight;
    wd += weight * difference;
    dd += difference * difference;
    return true;
  }
};

bool add_triangle(const FieldPoint& centre, const StarSide& side, const SampleField& field,
                  double tolerance_m, Feasible& feasible) {
  const Plane weight =
      plane_through({centre.column, centre.row, 1}, {side.from.column, side.from.row, 0},
                    {side.to.column, side.to.row, 0});
  const Plane rest = plane_through({centre.column, centre.row, 0}, side.from, side.to);
  return for_each_span(
      centre, side.from, side.to, field, kOnEdge_cells,
      [&](std::int64_t row, std::int64_t first, std::int64_t last) {
        const double* heights = field.row(row);
        for (std::int64_t column = first; column <= last; ++column) {
          if (std::isnan(heights[column])) continue;
          const auto x = static_cast<double>(column), y = static_cast<double>(row);
          if (!feasible.add(weight.at(x, y), heights[column] - rest.at(x, y), tolerance_m)) {
            return false;
          }
        }
        return feasible.lowest <= feasible.highest;
      });
}

}  // namespace

std::optional<StarHeight> fit_star(double column, double row, std::span<const StarSide> sides,
                                   const SampleField& field, double tolerance_m,
                                   double fallback_m) {
  const FieldPoint centre{column, row, 0};
  Feasible feasible;
  for (const StarSide& side : sides) {
    if (!add_triangle(centre, side, field, tolerance_m, feasible)) return std::nullopt;
  }
  StarHeight best{.lowest_m = feasible.lowest, .highest_m = feasible.highest};
  const double wished = feasible.ww > 0 ? feasible.wd / feasible.ww : fallback_m;
  best.height_m = std::clamp(wished, feasible.lowest, feasible.highest);
  const double z = best.height_m;
  best.squared_error_m2 = feasible.dd - 2 * z * feasible.wd + z * z * feasible.ww;
  return best;
}

bool is_within(const FieldPoint& a, const FieldPoint& b, const FieldPoint& c,
               const SampleField& field, double tolerance_m) {
  const Plane plane = plane_through(a, b, c);
  return for_each_span(a, b, c, field, field.slack_cells,
                       [&](std::int64_t row, std::int64_t first, std::int64_t last) {
                         const double* heights = field.row(row);
                         for (std::int64_t column = first; column <= last; ++column) {
                           const double z =
                               plane.at(static_cast<double>(column), static_cast<double>(row));
                           // written so that NaN, no data, passes
                           if (std::abs(z - heights[column]) > tolerance_m) return false;
                         }
                         return true;
                       });
}

}  // namespace terrane::hierarchy

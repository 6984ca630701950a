#include "mesh_judge.h"

#include <algorithm>
#include <cmath>

namespace terrane::peers {
namespace {

constexpr double kOnEdge_cells = 1e-6;

using Point = std::array<double, 3>;

double cross(const Point& o, const Point& a, const Point& b) {
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

double length(const Point& a, const Point& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

void add_triangle(const std::array<Point, 3>& p, const HeightGrid& grid,
                  std::vector<double>& worst_m) {
  const double area = cross(p[0], p[1], p[2]);
  const auto range = [&](int axis, std::int64_t count) {
    const auto [low, high] = std::minmax({p[0][axis], p[1][axis], p[2][axis]});
    return std::pair{std::max(0.0, std::ceil(low - kOnEdge_cells)),
                     std::min(static_cast<double>(count - 1), std::floor(high + kOnEdge_cells))};
  };
  const auto [first_column, last_column] = range(0, grid.window.columns);
  const auto [first_row, last_row] = range(1, grid.window.rows);
  for (double row = first_row; row <= last_row; ++row) {
    for (double column = first_column; column <= last_column; ++column) {
      const Point at{column, row, 0};
      double height_m = 0;
      bool is_inside = true;
      for (int k = 0; k < 3; ++k) {
        const Point &a = p[(k + 1) % 3], &b = p[(k + 2) % 3];
        const double twice_area = cross(a, b, at) * (area < 0 ? -1 : 1);
        is_inside = is_inside && twice_area >= -kOnEdge_cells * length(a, b);
        height_m += twice_area / std::abs(area) * p[k][2];
      }
      if (!is_inside) continue;
      const auto sample =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.window.columns) +
          static_cast<std::size_t>(column);
      worst_m[sample] = std::max(worst_m[sample],
                                 std::abs(height_m - static_cast<double>(grid.heights_m[sample])));
    }
  }
}

}  // namespace

Verdict judge(const PeerMesh& mesh, const HeightGrid& grid) {
  constexpr double kNoArea_cells2 = 1e-9;
  constexpr double kUncovered = -1;
  std::vector<double> worst_m(grid.heights_m.size(), kUncovered);
  std::int64_t left = 0, right = 0, flat = 0;
  for (const Triangle& t : mesh.triangles) {
    const std::array<Point, 3> p{mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]};
    const double area = cross(p[0], p[1], p[2]);
    if (std::abs(area) < kNoArea_cells2) {
      ++flat;
      continue;
    }
    ++(area > 0 ? left : right);
    add_triangle(p, grid, worst_m);
  }
  Verdict verdict{.folded = flat + std::min(left, right)};
  double sum_m2 = 0;
  std::int64_t covered = 0;
  for (const double worst : worst_m) {
    if (worst == kUncovered) {
      ++verdict.uncovered;
      continue;
    }
    ++covered;
    sum_m2 += worst * worst;
    verdict.max_m = std::max(verdict.max_m, worst);
  }
  if (covered > 0) verdict.rms_m = std::sqrt(sum_m2 / static_cast<double>(covered));
  return verdict;
}

}  // namespace terrane::peers

#include "tiler/tile/grid_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace terrane::tiler {
namespace {

using hierarchy::GridPoint;
using hierarchy::kUnitsPerCell;
using hierarchy::orient2d;
using hierarchy::TerrainMesh;
using hierarchy::TerrainVertex;

constexpr double kUnmeasured = -1;

std::int64_t floor_div(std::int64_t a, std::int64_t b) {
  return a / b - (a % b != 0 && (a < 0) != (b < 0) ? 1 : 0);
}
std::int64_t ceil_div(std::int64_t a, std::int64_t b) { return -floor_div(-a, b); }

/// Columns first ... last of one row of samples.
struct Span {
  std::int64_t first, last;
};

/// Keeps the columns of \p span whose samples lie on the left of the line from a to b, or on it.
void clip(Span& span, GridPoint a, GridPoint b, std::int64_t row) {
  const std::int64_t dx = std::int64_t{b.x} - a.x, dy = std::int64_t{b.y} - a.y;
  // orient2d(a, b, sample) = at_zero - dy * kUnitsPerCell * column
  const std::int64_t at_zero = dx * (-row * kUnitsPerCell - a.y) + dy * a.x;
  const std::int64_t per_column = dy * kUnitsPerCell;
  if (per_column > 0) span.last = std::min(span.last, floor_div(at_zero, per_column));
  if (per_column < 0) span.first = std::max(span.first, ceil_div(-at_zero, -per_column));
  if (per_column == 0 && at_zero < 0) span.last = span.first - 1;
}

/// The samples of one grid, and how far a mesh is from them.
class Measurement {
 public:
  explicit Measurement(const HeightGrid& grid)
      : grid_(grid), worst_m_(grid.heights_m.size(), kUnmeasured) {}

  void add(const TerrainVertex& a, const TerrainVertex& b, const TerrainVertex& c) {
    const std::array<GridPoint, 3> p{a.place.plan, b.place.plan, c.place.plan};
    const std::int64_t area = orient2d(p[0], p[1], p[2]);
    if (area <= 0) return;
    const Window& window = grid_.window;
    const auto [low, high] = std::ranges::minmax({-p[0].y, -p[1].y, -p[2].y});
    const std::int64_t first_row = std::max(window.row, ceil_div(low, kUnitsPerCell));
    const std::int64_t last_row =
        std::min(window.row + window.rows - 1, floor_div(high, kUnitsPerCell));
    for (std::int64_t row = first_row; row <= last_row; ++row) {
      Span span{window.column, window.column + window.columns - 1};
      for (std::size_t k = 0; k < 3; ++k) clip(span, p[k], p[(k + 1) % 3], row);
      for (std::int64_t column = span.first; column <= span.last; ++column) {
        const GridPoint at{static_cast<std::int32_t>(column * kUnitsPerCell),
                           static_cast<std::int32_t>(-row * kUnitsPerCell)};
        const auto wa = static_cast<double>(orient2d(p[1], p[2], at));
        const auto wb = static_cast<double>(orient2d(p[2], p[0], at));
        const auto wc = static_cast<double>(orient2d(p[0], p[1], at));
        const double height_m =
            (wa * a.place.height_m + wb * b.place.height_m + wc * c.place.height_m) /
            static_cast<double>(area);
        double& worst_m = worst_m_[static_cast<std::size_t>((row - window.row) * window.columns +
                                                            column - window.column)];
        const double wanted_m = grid_.heights_m[&worst_m - worst_m_.data()];
        if (!std::isnan(wanted_m)) worst_m = std::max(worst_m, std::abs(height_m - wanted_m));
      }
    }
  }

  void add(const TerrainMesh& mesh) {
    for (const auto& [a, b, c] : mesh.triangles) {
      add(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
    }
  }

  /// Adds what was found to \p error, whose rms_m holds the sum of squares meanwhile.
  void report(GridError& error) const {
    for (std::size_t i = 0; i < worst_m_.size(); ++i) {
      if (worst_m_[i] == kUnmeasured) {
        error.uncovered += std::isnan(grid_.heights_m[i]) ? 0 : 1;
        continue;
      }
      ++error.samples;
      error.max_m = std::max(error.max_m, worst_m_[i]);
      error.rms_m += worst_m_[i] * worst_m_[i];
    }
  }

 private:
  const HeightGrid& grid_;
  std::vector<double> worst_m_;
};

std::int64_t folded_triangles(const TerrainMesh& mesh) {
  return std::ranges::count_if(mesh.triangles, [&](const hierarchy::Corners& c) {
    return orient2d(mesh.vertices[c[0]].place.plan, mesh.vertices[c[1]].place.plan,
                    mesh.vertices[c[2]].place.plan) <= 0;
  });
}

/// Turns the sum of squares in rms_m into their mean's root.
void finish(GridError& error) {
  if (error.samples > 0) error.rms_m = std::sqrt(error.rms_m / static_cast<double>(error.samples));
}

}  // namespace

GridError measure_over_grid(const TerrainMesh& mesh, const HeightGrid& grid) {
  GridError error{.folded = folded_triangles(mesh)};
  Measurement measurement(grid);
  measurement.add(mesh);
  measurement.report(error);
  finish(error);
  return error;
}

GridError measure_over_dem(const TerrainMesh& mesh, const HeightSource& heights,
                           std::int64_t samples_at_once) {
  const GridShape shape = heights.shape();
  const std::int64_t rows_at_once = std::max<std::int64_t>(1, samples_at_once / shape.columns);
  GridError error{.folded = folded_triangles(mesh)};
  for (std::int64_t row = 0; row < shape.rows; row += rows_at_once) {
    const HeightGrid strip =
        heights.read({0, row, shape.columns, std::min(rows_at_once, shape.rows - row)});
    Measurement measurement(strip);
    measurement.add(mesh);
    measurement.report(error);
  }
  finish(error);
  return error;
}

}  // namespace terrane::tiler

#include "tiler/measure.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "hierarchy/collapse/sample_field.h"

namespace terrane::tiler {
namespace {

using hierarchy::FieldPoint;

// in cells, and as a share of a triangle
constexpr double kOnEdge = 1e-7;

class Measurement {
 public:
  Measurement(const TileFrame& frame, double step_m, const HeightGrid& grid, const Window& window)
      : frame_(frame),
        step_m_(step_m),
        grid_(grid),
        window_(window),
        extent_{window.columns, window.rows, {}},
        worst_m_(static_cast<std::size_t>(window.columns * window.rows), kUnmeasured) {}

  void add_triangle(const WorldVertex& a, const WorldVertex& b, const WorldVertex& c) {
    // as a ray along the plumb line meets a triangle (Moeller and Trumbore 1997)
    const Eigen::Vector3d corner = a.world;
    const Eigen::Vector3d side_b = b.world - corner, side_c = c.world - corner;
    const double slack_cells =
        kOnEdge + std::max({bend_cells(a, b), bend_cells(b, c), bend_cells(c, a)});
    for_each_span(a.plan, b.plan, c.plan, extent_, slack_cells,
                  [&](std::int64_t row, std::int64_t first, std::int64_t last) {
                    for (std::int64_t column = first; column <= last; ++column) {
                      const Plumb plumb = plumb_at(column, row);
                      const Eigen::Vector3d p = plumb.up.cross(side_c);
                      const Eigen::Vector3d s = plumb.base - corner;
                      const Eigen::Vector3d q = s.cross(side_b);
                      const double scale = 1 / side_b.dot(p);
                      const double u = s.dot(p) * scale, v = plumb.up.dot(q) * scale;
                      if (u < -kOnEdge || v < -kOnEdge || u + v > 1 + kOnEdge) continue;
                      add(column, row, side_c.dot(q) * scale);
                    }
                    return true;
                  });
  }

  /// Measures what no triangle covers, but lies within a step of the edge.
  void add_rim(const WorldVertex& a, const WorldVertex& b) {
    const FieldPoint from = a.plan, to = b.plan;
    const double reach = step_m_ / frame_.spacing_m();
    const auto first_column = std::ceil(std::min(from.column, to.column) - reach);
    const auto last_column = std::floor(std::max(from.column, to.column) + reach);
    const auto first_row = std::ceil(std::min(from.row, to.row) - reach);
    const auto last_row = std::floor(std::max(from.row, to.row) + reach);
    for (double row = std::max(0.0, first_row);
         row <= std::min(last_row, static_cast<double>(window_.rows - 1)); ++row) {
      for (double column = std::max(0.0, first_column);
           column <= std::min(last_column, static_cast<double>(window_.columns - 1)); ++column) {
        add_near_rim(static_cast<std::int64_t>(column), static_cast<std::int64_t>(row), a, b);
      }
    }
  }

  MeasuredError result() const {
    MeasuredError result;
    for (const double error_m : worst_m_) {
      if (error_m == kUnmeasured) continue;
      result.max_m = std::max(result.max_m, error_m);
      result.sum_of_squares_m2 += error_m * error_m;
      ++result.samples;
    }
    // heights are taken at the frame's places, which are off by a little: on slopes of up to 3 the
    // heights then are by four times that at most
    result.max_m += 4 * frame_.accuracy_m();
    return result;
  }

 private:
  static constexpr double kUnmeasured = -1;

  Plumb plumb_at(std::int64_t column, std::int64_t row) const {
    return frame_.plumb(static_cast<double>(column), static_cast<double>(row));
  }

  double& worst_m(std::int64_t column, std::int64_t row) {
    return worst_m_[static_cast<std::size_t>(row * window_.columns + column)];
  }

  /// How far the straight edge in the world lies beside the straight line over the grid, about.
  double bend_cells(const WorldVertex& a, const WorldVertex& b) const {
    const FieldPoint from = a.plan, to = b.plan;
    const auto base = [&](double t) -> Eigen::Vector3d {
      return frame_
          .plumb(from.column + t * (to.column - from.column), from.row + t * (to.row - from.row))
          .base;
    };
    const Plumb middle = frame_.plumb((from.column + to.column) / 2, (from.row + to.row) / 2);
    const Eigen::Vector3d gap = middle.base - (base(0) + base(1)) / 2;
    constexpr double kToBeSure = 2;
    return kToBeSure * (gap - gap.dot(middle.up) * middle.up).norm() / frame_.spacing_m();
  }

  /// A sample on an edge is under two triangles: the worse one stays, and it counts once.
  void add(std::int64_t column, std::int64_t row, double on_mesh_m) {
    const double height_m = grid_.at(window_.column + column, window_.row + row);
    if (std::isnan(height_m)) return;
    worst_m(column, row) = std::max(worst_m(column, row), std::abs(on_mesh_m - height_m));
  }

  void add_near_rim(std::int64_t column, std::int64_t row, const WorldVertex& a,
                    const WorldVertex& b) {
    if (worst_m(column, row) != kUnmeasured) return;
    const Plumb plumb = plumb_at(column, row);
    const auto flat = [&](const Eigen::Vector3d& v) -> Eigen::Vector3d {
      return v - v.dot(plumb.up) * plumb.up;
    };
    const Eigen::Vector3d from = a.world, along = b.world - from;
    const double length2 = std::max(flat(along).squaredNorm(), 1e-30);
    const double t = std::clamp(flat(plumb.base - from).dot(flat(along)) / length2, 0.0, 1.0);
    const Eigen::Vector3d nearest = from + t * along;
    if (flat(nearest - plumb.base).norm() > step_m_) return;
    add(column, row, (nearest - plumb.base).dot(plumb.up));
  }

  const TileFrame& frame_;
  double step_m_;
  const HeightGrid& grid_;
  const Window& window_;
  hierarchy::SampleField extent_;
  std::vector<double> worst_m_;
};

}  // namespace

MeasuredError measure(std::span<const WorldVertex> vertices,
                      std::span<const hierarchy::Corners> triangles, std::span<const Edge> rim,
                      const TileFrame& frame, double step_m, const HeightGrid& grid,
                      const Window& window) {
  Measurement measurement(frame, step_m, grid, window);
  for (const auto& [a, b, c] : triangles) {
    measurement.add_triangle(vertices[a], vertices[b], vertices[c]);
  }
  for (const auto& [a, b] : rim) measurement.add_rim(vertices[a], vertices[b]);
  return measurement.result();
}

}  // namespace terrane::tiler

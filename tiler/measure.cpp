#include "tiler/measure.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "hierarchy/collapse/sample_field.h"

namespace terrane::tiler {

using hierarchy::FieldPoint;

MeasuredError measure(std::span<const hierarchy::Place> places,
                      std::span<const hierarchy::Corners> triangles, const TileFrame& frame,
                      const Lattice& lattice, int level, const HeightGrid& grid,
                      const Window& window) {
  const hierarchy::SampleField extent{window.columns, window.rows, {}};
  // a sample on an edge is under two triangles: keep the worse, count it once
  std::vector<double> worst(static_cast<std::size_t>(window.columns * window.rows), -1);

  for (const hierarchy::Corners& corners : triangles) {
    FieldPoint corner[3];
    Eigen::Vector3d world[3];
    for (int k = 0; k < 3; ++k) {
      const hierarchy::Place& place = places[corners[k]];
      corner[k] = {hierarchy::column_of(place.plan), hierarchy::row_of(place.plan), 0};
      world[k] = lattice.world(place.lattice, level);
    }
    const Eigen::Vector3d normal = (world[1] - world[0]).cross(world[2] - world[0]);
    for_each_span(corner[0], corner[1], corner[2], extent,
                  [&](std::int64_t row, std::int64_t first, std::int64_t last) {
                    for (std::int64_t column = first; column <= last; ++column) {
                      const double height_m = grid.at(window.column + column, window.row + row);
                      if (std::isnan(height_m)) continue;
                      const Plumb plumb =
                          frame.plumb(static_cast<double>(column), static_cast<double>(row));
                      const double on_mesh_m =
                          normal.dot(world[0] - plumb.base) / normal.dot(plumb.up);
                      double& error = worst[static_cast<std::size_t>(row * window.columns + column)];
                      error = std::max(error, std::abs(on_mesh_m - height_m));
                    }
                    return true;
                  });
  }

  MeasuredError result;
  for (const double error : worst) {
    if (error < 0) continue;
    result.max_m = std::max(result.max_m, error);
    result.sum_of_squares_m2 += error * error;
    ++result.samples;
  }
  return result;
}

}  // namespace terrane::tiler

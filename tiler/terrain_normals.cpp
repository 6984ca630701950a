#include "tiler/terrain_normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

namespace terrane::tiler {
namespace {

std::optional<double> height_at(const HeightGrid& grid, std::int64_t column, std::int64_t row) {
  const Window& w = grid.window;
  if (column < w.column || row < w.row || column >= w.column + w.columns || row >= w.row + w.rows ||
      !grid.has_data(column, row)) {
    return std::nullopt;
  }
  return grid.at(column, row);
}

/// Metres of height per cell along (dc, dr), from both sides of a sample or from the one with data.
double slope(const HeightGrid& grid, std::int64_t column, std::int64_t row, std::int64_t dc,
             std::int64_t dr) {
  const auto here = height_at(grid, column, row);
  const auto before = height_at(grid, column - dc, row - dr);
  const auto after = height_at(grid, column + dc, row + dr);
  const auto cells = static_cast<double>(dc + dr);
  if (before && after) return (*after - *before) / (2 * cells);
  if (here && after) return (*after - *here) / cells;
  if (here && before) return (*here - *before) / cells;
  return 0;
}

}  // namespace

std::int64_t normal_reach(int level) { return level < 2 ? 1 : std::int64_t{1} << (level - 1); }

std::vector<Eigen::Vector3f> terrain_normals(std::span<const hierarchy::Place> places,
                                             const TileFrame& frame, int level,
                                             const HeightGrid& grid, const Window& window) {
  const std::int64_t reach = normal_reach(level);
  std::vector<Eigen::Vector3f> normals;
  normals.reserve(places.size());
  for (const hierarchy::Place& place : places) {
    const double c = hierarchy::column_of(place.plan), r = hierarchy::row_of(place.plan);
    const std::int64_t column = window.column + std::llround(c), row = window.row + std::llround(r);
    const Plumb here = frame.plumb(c, r);
    const Eigen::Vector3d along_columns = frame.plumb(c + 0.5, r).base -
                                          frame.plumb(c - 0.5, r).base +
                                          slope(grid, column, row, reach, 0) * here.up;
    const Eigen::Vector3d along_rows = frame.plumb(c, r + 0.5).base - frame.plumb(c, r - 0.5).base +
                                       slope(grid, column, row, 0, reach) * here.up;
    const Eigen::Vector3d normal = along_columns.cross(along_rows).normalized();
    normals.push_back((normal.dot(here.up) < 0 ? Eigen::Vector3d(-normal) : normal).cast<float>());
  }
  return normals;
}

}  // namespace terrane::tiler

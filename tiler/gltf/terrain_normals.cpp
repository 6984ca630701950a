#include "tiler/gltf/terrain_normals.h"

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

/// The sample of the DEM that is nearest to a place of the tile.
hierarchy::SampleId nearest_sample(const hierarchy::Place& place, const Window& tile) {
  return {static_cast<std::int32_t>(tile.column + std::llround(hierarchy::column_of(place.plan))),
          static_cast<std::int32_t>(tile.row + std::llround(hierarchy::row_of(place.plan)))};
}

Eigen::Vector3f normal_at(const hierarchy::Place& place, const TileFrame& frame, std::int64_t reach,
                          const HeightGrid& grid, const Window& tile) {
  const double c = hierarchy::column_of(place.plan), r = hierarchy::row_of(place.plan);
  const auto [column, row] = nearest_sample(place, tile);
  const Plumb here = frame.plumb(c, r);
  const Eigen::Vector3d along_columns = frame.plumb(c + 0.5, r).base -
                                        frame.plumb(c - 0.5, r).base +
                                        slope(grid, column, row, reach, 0) * here.up;
  const Eigen::Vector3d along_rows = frame.plumb(c, r + 0.5).base - frame.plumb(c, r - 0.5).base +
                                     slope(grid, column, row, 0, reach) * here.up;
  const Eigen::Vector3d normal = along_columns.cross(along_rows).normalized();
  return (normal.dot(here.up) < 0 ? Eigen::Vector3d(-normal) : normal).cast<float>();
}

}  // namespace

std::int64_t normal_reach(int octave) { return octave < 2 ? 1 : std::int64_t{1} << (octave - 1); }

std::vector<Eigen::Vector3f> terrain_normals(std::span<const hierarchy::Place> places,
                                             const TileFrame& frame, int octave,
                                             const TileSamples& samples) {
  std::vector<std::vector<std::size_t>> in_patch(samples.patch_count());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto [column, row] = nearest_sample(places[i], samples.window());
    in_patch[samples.patch_of(column, row)].push_back(i);
  }
  std::vector<Eigen::Vector3f> normals(places.size());
  samples.for_each_patch([&](std::size_t k, const Window&, const HeightGrid& grid) {
    for (const std::size_t i : in_patch[k]) {
      normals[i] = normal_at(places[i], frame, normal_reach(octave), grid, samples.window());
    }
  });
  return normals;
}

}  // namespace terrane::tiler

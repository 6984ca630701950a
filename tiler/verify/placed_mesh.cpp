#include "tiler/verify/placed_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace terrane::verify {
namespace {

constexpr double kEarthRadius_m = 6.37e6;

constexpr double kLeastMargin_cells = 0.5;  // covers what GridLocator's table is off by

/// Leaf blocks [begin, end) that an interval of columns (or rows) touches.
std::array<std::int64_t, 2> blocks_touched(double low, double high, std::int64_t cells,
                                           std::int64_t first, std::int64_t count) {
  const double last_block = static_cast<double>(count - 1);
  const auto cells_f = static_cast<double>(cells);
  const auto first_f = static_cast<double>(first);
  // a sample on the border between two blocks belongs to both
  const double begin = std::clamp(std::ceil(low / cells_f - 1 - first_f), 0.0, last_block);
  const double end = std::clamp(std::floor(high / cells_f - first_f), 0.0, last_block);
  return {static_cast<std::int64_t>(begin), static_cast<std::int64_t>(end) + 1};
}

}  // namespace

PlacedMesh::PlacedMesh(TileMesh mesh, const Output& output, const World& world)
    : mesh_(std::move(mesh)),
      step_m_(output.levels[static_cast<std::size_t>(mesh_.key.level)].step_m),
      reach_m_(output.reach_m(mesh_.key.level)),
      tiling_(output.tiling),
      locator_(world, output.tiling.window(mesh_.key)),
      is_flat_(output.frame.is_local),
      region_(mesh_.key.level + 1 < output.tiling.level_count() ? tiling_.parent(mesh_.key)
                                                                : mesh_.key) {
  place_vertices();
  set_margins();
  fill_buckets();
}

Eigen::Vector3d PlacedMesh::corner(std::uint32_t vertex, double t) const {
  Eigen::Vector3d place;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    place[static_cast<Eigen::Index>(axis)] = static_cast<double>(mesh_.position[vertex][axis]) +
                                             t * static_cast<double>(mesh_.morph[vertex][axis]);
  }
  return place.cwiseProduct(step_m_);
}

GridPosition PlacedMesh::grid_position(std::uint32_t vertex, double t) const {
  const GridPosition& from = located_[vertex][0].at;
  const GridPosition& to = located_[vertex][1].at;
  return {from.column + t * (to.column - from.column), from.row + t * (to.row - from.row)};
}

void PlacedMesh::place_vertices() {
  located_.resize(mesh_.position.size());
  for (std::size_t v = 0; v < located_.size(); ++v) {
    const auto vertex = static_cast<std::uint32_t>(v);
    located_[v][0] = locator_.locate(corner(vertex, 0));
    const bool moves = mesh_.morph[v] != Lattice{0, 0, 0};
    located_[v][1] = moves ? locator_.locate(corner(vertex, 1)) : located_[v][0];
  }
}

void PlacedMesh::set_margins() {
  const double cell_m = std::min(locator_.column_size_m(), locator_.row_size_m());
  for (const auto& triangle : mesh_.triangles) {
    Eigen::Vector3d low = corner(triangle[0], 0);
    Eigen::Vector3d high = low;
    for (const std::uint32_t vertex : triangle) {
      for (const double t : {0.0, 1.0}) {
        low = low.cwiseMin(corner(vertex, t));
        high = high.cwiseMax(corner(vertex, t));
      }
    }
    // straight lines of the world are curved on the grid: by about size^2 / R
    const double bend_m = is_flat_ ? 0 : 2 * (high - low).squaredNorm() / kEarthRadius_m;
    margin_cells_.push_back(static_cast<float>(kLeastMargin_cells + (bend_m + reach_m_) / cell_m));
  }
}

template <typename Visit>
void PlacedMesh::for_each_bucket(std::size_t triangle, Visit visit) const {
  GridPosition low = located_[mesh_.triangles[triangle][0]][0].at;
  GridPosition high = low;
  for (const std::uint32_t vertex : mesh_.triangles[triangle]) {
    for (const auto& located : located_[vertex]) {
      low = {std::min(low.column, located.at.column), std::min(low.row, located.at.row)};
      high = {std::max(high.column, located.at.column), std::max(high.row, located.at.row)};
    }
  }
  const double margin = margin_cells_[triangle];
  const std::int64_t cells = tiling_.tile_cells;
  const auto columns = blocks_touched(low.column - margin, high.column + margin, cells,
                                      region_.x << tiling_.octave(region_.level), bucket_columns_);
  const auto rows = blocks_touched(low.row - margin, high.row + margin, cells,
                                   region_.y << tiling_.octave(region_.level), bucket_rows_);
  for (std::int64_t row = rows[0]; row < rows[1]; ++row) {
    for (std::int64_t column = columns[0]; column < columns[1]; ++column) {
      visit(static_cast<std::size_t>(row * bucket_columns_ + column));
    }
  }
}

void PlacedMesh::fill_buckets() {
  const std::int64_t blocks = std::int64_t{1} << tiling_.octave(region_.level);
  bucket_columns_ = std::min(blocks, tiling_.tile_columns(0) - region_.x * blocks);
  bucket_rows_ = std::min(blocks, tiling_.tile_rows(0) - region_.y * blocks);
  // counting sort: sizes, then begins, then the triangles themselves
  bucket_begin_.assign(static_cast<std::size_t>(bucket_columns_ * bucket_rows_) + 1, 0);
  for (std::size_t n = 0; n < mesh_.triangles.size(); ++n) {
    for_each_bucket(n, [&](std::size_t bucket) { ++bucket_begin_[bucket + 1]; });
  }
  std::partial_sum(bucket_begin_.begin(), bucket_begin_.end(), bucket_begin_.begin());
  bucket_triangles_.resize(bucket_begin_.back());
  std::vector<std::uint32_t> next(bucket_begin_.begin(), bucket_begin_.end() - 1);
  for (std::size_t n = 0; n < mesh_.triangles.size(); ++n) {
    for_each_bucket(n, [&](std::size_t bucket) {
      bucket_triangles_[next[bucket]++] = static_cast<std::uint32_t>(n);
    });
  }
}

std::span<const std::uint32_t> PlacedMesh::triangles_over(const TileKey& leaf) const {
  const std::int64_t column = leaf.x - (region_.x << tiling_.octave(region_.level));
  const std::int64_t row = leaf.y - (region_.y << tiling_.octave(region_.level));
  const auto bucket = static_cast<std::size_t>(row * bucket_columns_ + column);
  return std::span(bucket_triangles_)
      .subspan(bucket_begin_[bucket], bucket_begin_[bucket + 1] - bucket_begin_[bucket]);
}

bool PlacedMesh::is_folded(std::size_t triangle, double t) const {
  const auto& [a, b, c] = mesh_.triangles[triangle];
  const Eigen::Vector3d origin = corner(a, t);
  const Eigen::Vector3d normal = (corner(b, t) - origin).cross(corner(c, t) - origin);
  Eigen::Vector3d up = Eigen::Vector3d::Zero();  // at the centroid, three times as long
  for (const std::uint32_t vertex : mesh_.triangles[triangle]) {
    up += (1 - t) * located_[vertex][0].up + t * located_[vertex][1].up;
  }
  return !(normal.dot(up) > 0);
}

std::int64_t PlacedMesh::count_folded(double t) const {
  std::int64_t folded = 0;
  for (std::size_t n = 0; n < mesh_.triangles.size(); ++n) folded += is_folded(n, t);
  return folded;
}

std::int64_t PlacedMesh::first_folded(double t) const {
  for (std::size_t n = 0; n < mesh_.triangles.size(); ++n) {
    if (is_folded(n, t)) return static_cast<std::int64_t>(n);
  }
  return -1;
}

}  // namespace terrane::verify

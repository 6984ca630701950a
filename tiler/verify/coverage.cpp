#include "tiler/verify/coverage.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace terrane::verify {
namespace {

// of a triangle's size; far below a lattice step, far above the rounding of doubles
constexpr double kBarycentricSlack = 1e-9;

using Corners = std::array<Eigen::Vector3d, 3>;

/// Height of a triangle over a sample, along its vertical; nothing if that misses the triangle.
///
/// \par Source
/// Moeller, Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection" (1997), for a line.
std::optional<double> height_over(const Sample& sample, const Corners& corners) {
  const Eigen::Vector3d edge_1 = corners[1] - corners[0];
  const Eigen::Vector3d edge_2 = corners[2] - corners[0];
  const Eigen::Vector3d p = sample.up.cross(edge_2);
  const double inverse = 1 / edge_1.dot(p);
  const Eigen::Vector3d from_corner = sample.place - corners[0];
  const double u = from_corner.dot(p) * inverse;
  const Eigen::Vector3d q = from_corner.cross(edge_1);
  const double v = sample.up.dot(q) * inverse;
  // written so that a triangle on edge (NaN) is a miss
  const bool is_hit =
      u >= -kBarycentricSlack && v >= -kBarycentricSlack && u + v <= 1 + kBarycentricSlack;
  if (!is_hit) return std::nullopt;
  return edge_2.dot(q) * inverse;
}

struct Nearest {
  double distance_m = std::numeric_limits<double>::infinity();
  double height_m = 0;  // over the sample
};

/// Closest point of a triangle's edges, in the plane across the sample's vertical.
Nearest nearest_on_edges(const Sample& sample, const Corners& corners) {
  Nearest nearest;
  for (std::size_t n = 0; n < 3; ++n) {
    const Eigen::Vector3d a = corners[n] - sample.place;
    const Eigen::Vector3d edge = corners[(n + 1) % 3] - corners[n];
    const Eigen::Vector3d flat_a = a - a.dot(sample.up) * sample.up;
    const Eigen::Vector3d flat_edge = edge - edge.dot(sample.up) * sample.up;
    const double length_2 = flat_edge.squaredNorm();
    const double s = length_2 > 0 ? std::clamp(-flat_a.dot(flat_edge) / length_2, 0.0, 1.0) : 0.0;
    const double distance_m = (flat_a + s * flat_edge).norm();
    if (distance_m < nearest.distance_m) nearest = {distance_m, (a + s * edge).dot(sample.up)};
  }
  return nearest;
}

/// One triangle at one t, with the samples that it may cover.
struct Candidate {
  Corners corners;
  std::array<GridPosition, 3> at = {};
  double margin = 0;
  bool is_water = false;
  double first_column, last_column, first_row, last_row;

  /// Columns in which samples of a row may be under it, or within the margin.
  std::pair<double, double> columns_near(double row) const {
    double low = last_column, high = first_column;
    for (std::size_t n = 0; n < 3; ++n) {
      const GridPosition &a = at[n], &b = at[(n + 1) % 3];
      const double begin = std::max(std::min(a.row, b.row), row - margin);
      const double end = std::min(std::max(a.row, b.row), row + margin);
      if (begin > end) continue;
      for (const double y : {begin, end}) {
        const double column =
            a.row == b.row ? a.column
                           : a.column + (y - a.row) / (b.row - a.row) * (b.column - a.column);
        low = std::min(low, column);
        high = std::max(high, column);
      }
      if (a.row != b.row) continue;
      low = std::min(low, b.column);
      high = std::max(high, b.column);
    }
    return {low - margin, high + margin};
  }
  bool may_cover(double column, double row) const {
    return column >= first_column && column <= last_column && row >= first_row && row <= last_row;
  }
};

Candidate candidate(const PlacedMesh& mesh, std::uint32_t triangle, double t) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  const bool is_water = mesh.mesh().in_water[triangle];
  Candidate candidate{{}, {}, mesh.margin_cells(triangle), is_water, kFar, -kFar, kFar, -kFar};
  for (std::size_t n = 0; n < 3; ++n) {
    const std::uint32_t vertex = mesh.mesh().triangles[triangle][n];
    const GridPosition at = mesh.grid_position(vertex, t);
    candidate.corners[n] = mesh.corner(vertex, t);
    candidate.at[n] = at;
    candidate.first_column = std::min(candidate.first_column, at.column);
    candidate.last_column = std::max(candidate.last_column, at.column);
    candidate.first_row = std::min(candidate.first_row, at.row);
    candidate.last_row = std::max(candidate.last_row, at.row);
  }
  const double margin = candidate.margin;
  candidate.first_column -= margin;
  candidate.last_column += margin;
  candidate.first_row -= margin;
  candidate.last_row += margin;
  return candidate;
}

/// Whole numbers of an interval that lie in [first, first + count).
std::pair<std::int64_t, std::int64_t> clip(double low, double high, std::int64_t first,
                                           std::int64_t count) {
  const auto first_f = static_cast<double>(first);
  const auto last_f = static_cast<double>(first + count - 1);
  const double begin = std::clamp(std::ceil(low), first_f, last_f + 1);
  const double end = std::clamp(std::floor(high), first_f - 1, last_f);
  return {static_cast<std::int64_t>(begin), static_cast<std::int64_t>(end)};
}

void hit_samples(const SampleBlock& block, const Candidate& candidate,
                 std::vector<Verdict>& verdicts) {
  const Window& window = block.window;
  const auto [first_row, last_row] =
      clip(candidate.first_row, candidate.last_row, window.row, window.rows);
  for (std::int64_t row = first_row; row <= last_row; ++row) {
    const auto [low, high] = candidate.columns_near(static_cast<double>(row));
    const auto [first_column, last_column] = clip(low, high, window.column, window.columns);
    for (std::int64_t column = first_column; column <= last_column; ++column) {
      const Sample& sample = block.at(column, row);
      if (!sample.is_terrain) continue;
      const std::optional<double> height_m = height_over(sample, candidate.corners);
      if (!height_m) continue;
      Verdict& verdict = verdicts[block.index(column, row)];
      verdict = merge(verdict,
                      {Cover::kHit, std::abs(*height_m), !candidate.is_water, candidate.is_water});
    }
  }
}

/// A sample beside the outline: the closest edge within reach, or a triangle that was missed.
Verdict search_near(const Sample& sample, double column, double row,
                    const std::vector<Candidate>& candidates, double near_m) {
  Nearest nearest;
  for (const Candidate& candidate : candidates) {
    if (!candidate.may_cover(column, row)) continue;
    const Nearest here = nearest_on_edges(sample, candidate.corners);
    if (here.distance_m < nearest.distance_m) nearest = here;
  }
  if (nearest.distance_m > near_m) return {};
  return {Cover::kNear, std::abs(nearest.height_m)};
}

}  // namespace

Verdict merge(const Verdict& a, const Verdict& b) {
  if (a.cover != b.cover) return a.cover > b.cover ? a : b;
  Verdict worse = a.error_m > b.error_m ? a : b;
  worse.under_land = a.under_land || b.under_land;
  worse.under_water = a.under_water || b.under_water;
  return worse;
}

std::vector<Verdict> judge(const SampleBlock& block, const std::vector<const PlacedMesh*>& meshes,
                           double t, double near_m) {
  std::vector<Verdict> verdicts(block.samples.size());
  std::vector<Candidate> candidates;
  for (const PlacedMesh* mesh : meshes) {
    for (const std::uint32_t triangle : mesh->triangles_over(block.leaf)) {
      candidates.push_back(candidate(*mesh, triangle, t));
      hit_samples(block, candidates.back(), verdicts);
    }
  }
  const Window& window = block.window;
  for (std::int64_t row = window.row; row < window.row + window.rows; ++row) {
    for (std::int64_t column = window.column; column < window.column + window.columns; ++column) {
      Verdict& verdict = verdicts[block.index(column, row)];
      const Sample& sample = block.at(column, row);
      if (!sample.is_terrain || verdict.cover != Cover::kNone) continue;
      verdict = search_near(sample, static_cast<double>(column), static_cast<double>(row),
                            candidates, near_m);
    }
  }
  return verdicts;
}

}  // namespace terrane::verify

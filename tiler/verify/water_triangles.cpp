#include "tiler/verify/water_triangles.h"

#include <algorithm>
#include <cmath>

namespace terrane::verify {

WaterJudge::WaterJudge(const World& world, const Georeference& place,
                       std::span<const WaterArea> areas, double farthest_m)
    : world_(world),
      areas_(areas.begin(), areas.end()),
      // a coordinate of degrees is a length to a hundredth
      shores_(place, areas, 1.02 * farthest_m) {}

std::vector<WaterShores::Place> WaterJudge::find(const SampleBlock& block) const {
  const Window& window = block.window;
  std::vector<GridPosition> positions;
  for (std::int64_t row = window.row; row < window.row + window.rows; ++row) {
    for (std::int64_t column = window.column; column < window.column + window.columns; ++column) {
      positions.push_back({static_cast<double>(column), static_cast<double>(row)});
    }
  }
  return shores_.find(positions);
}

std::int64_t WaterJudge::count_uneven(const PlacedMesh& placed, const Eigen::Vector3d& step_m,
                                      double tolerance_m) const {
  const TileMesh& mesh = placed.mesh();
  std::vector<std::uint32_t> corners;
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
    if (mesh.in_water[n]) {
      corners.insert(corners.end(), mesh.triangles[n].begin(), mesh.triangles[n].end());
    }
  }
  if (corners.empty()) return 0;
  std::vector<Eigen::Vector3d> points;
  std::vector<GridPosition> positions;
  for (const std::uint32_t v : corners) {
    points.push_back(placed.corner(v, 0));
    positions.push_back(placed.grid_position(v, 0));
  }
  placed.locator().refine(points, positions);
  const std::vector<Plumb> plumbs = world_.plumb(positions);
  const std::vector<WaterShores::Place> places = shores_.find(positions);
  const auto is_even = [&](std::size_t i) {
    const double height_m = (points[i] - plumbs[i].base).dot(plumbs[i].up);
    // half a step of this level, and the halves of those before it
    const double rounding_m = plumbs[i].up.cwiseAbs().dot(step_m);
    if (places[i].inside_m == 0 && places[i].outside_m > tolerance_m + rounding_m) return false;
    return std::ranges::any_of(places[i].near, [&](std::size_t area) {
      const auto& wanted_m = areas_[area].height_m;
      return !wanted_m || std::abs(height_m - *wanted_m) <= rounding_m;
    });
  };
  std::int64_t uneven = 0;
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    uneven += !(is_even(i) && is_even(i + 1) && is_even(i + 2));
  }
  return uneven;
}

bool is_on_wrong_side(const Verdict& verdict, const WaterShores::Place& place, double tolerance_m) {
  if (verdict.cover != Cover::kHit) return false;
  return (place.inside_m > tolerance_m && !verdict.under_water) ||
         (place.outside_m > tolerance_m && !verdict.under_land);
}

}  // namespace terrane::verify

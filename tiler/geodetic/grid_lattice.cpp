#include "tiler/geodetic/grid_lattice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/errors.h"

namespace terrane::tiler {
namespace {

constexpr double kEquator_m = 6378137;

double steps_per_cell(int level) {
  return std::ldexp(static_cast<double>(kTileSteps) / static_cast<double>(kGeodeticTileCells),
                    -level);
}

std::int64_t round(double value) { return static_cast<std::int64_t>(std::floor(value + 0.5)); }

/// A power of two of metres. A float holds 2^24 of them, so minimum and maximum of a tile are
/// exact.
double height_step_m(double min_height_m, double max_height_m, double tolerance_m) {
  constexpr double kMostSteps = kTileSteps - 2;  // both ends are rounded outward
  const double farthest_m = std::max(std::abs(min_height_m), std::abs(max_height_m));
  // vertices may stand above the highest sample, and below the lowest
  const double range_m = max_height_m - min_height_m + 2 * tolerance_m;
  const double smallest_m = std::max(
      {range_m / kMostSteps, std::ldexp(farthest_m + tolerance_m, -22), std::ldexp(1.0, -10)});
  const double step_m = std::max(std::exp2(std::floor(std::log2(tolerance_m / 16))),
                                 std::exp2(std::ceil(std::log2(smallest_m))));
  if (step_m <= tolerance_m / 2) return step_m;
  throw ConfigError(
      fmt::format("--tolerance {}: quantized-mesh has {} steps of height a tile, {:.3g} m each for "
                  "heights from "
                  "{:.0f} to {:.0f} m. Use a tolerance of {:.3g} m or more",
                  tolerance_m, kTileSteps, step_m, min_height_m, max_height_m, 2 * step_m));
}

std::vector<Eigen::Vector3d> steps_m(const GeodeticTiles& band, double min_height_m,
                                     double max_height_m, const std::vector<double>& tolerance_m) {
  const double finest_m = kEquator_m * GeodeticZoom{band.zoom}.tile_deg() * std::numbers::pi / 180 /
                          static_cast<double>(kTileSteps);
  std::vector<Eigen::Vector3d> result;
  for (std::size_t level = 0; level < tolerance_m.size(); ++level) {
    const double plan_m = std::ldexp(finest_m, static_cast<int>(level));
    result.emplace_back(plan_m, plan_m,
                        height_step_m(min_height_m, max_height_m, tolerance_m[level]));
  }
  return result;
}

}  // namespace

GridLattice::GridLattice(const GeodeticTiles& band, const WorldFrame& world, double min_height_m,
                         double max_height_m, const std::vector<double>& tolerance_m)
    : Lattice(steps_m(band, min_height_m, max_height_m, tolerance_m)), world_(world) {}

double GridLattice::smallest_altitude_steps() const {
  // a sixteenth of a cell: every level is rounded anew, and thinner triangles are steep where the
  // terrain is (a wall of 400 m was 97 m off with 4 steps)
  return 32;
}

std::optional<Lattice::OverGrid> GridLattice::over_grid(const LatticePoint& point,
                                                        int level) const {
  const double steps = steps_per_cell(level);
  return OverGrid{{static_cast<double>(point.i) / steps, static_cast<double>(-point.j) / steps},
                  static_cast<double>(point.k) * step_m(level).z()};
}

LatticePoint GridLattice::nearest_over_grid(const OverGrid& place, int level) const {
  const double steps = steps_per_cell(level);
  return {round(place.at.column * steps), round(-place.at.row * steps),
          round(place.height_m / step_m(level).z())};
}

LatticePoint GridLattice::of_sample(GridPosition sample, const Plumb& /*plumb*/, double height_m,
                                    int level) const {
  return nearest_over_grid({sample, height_m}, level);
}

Eigen::Vector3d GridLattice::world(const LatticePoint& point, int level) const {
  const OverGrid place = *over_grid(point, level);
  const Plumb plumb = world_.plumbs({&place.at, 1}).front();
  return plumb.base + place.height_m * plumb.up;
}

}  // namespace terrane::tiler

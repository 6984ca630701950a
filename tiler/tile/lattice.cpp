#include "tiler/tile/lattice.h"

#include <cassert>
#include <cmath>

namespace terrane::tiler {
namespace {

// along a leaf tile, or half as many, however wide the tolerance: 64 to 128 a cell
constexpr double kEnoughSteps = 8192;

Eigen::Vector3d extent(const Pyramid& pyramid, const WorldFrame& world, const TileId& tile,
                       const HeightStatistics& heights) {
  const Window window = pyramid.window(tile);
  std::vector<GridPosition> probes;
  for (const double u : {0.0, 0.5, 1.0}) {
    for (const double v : {0.0, 0.5, 1.0}) {
      probes.push_back(
          {static_cast<double>(window.column) + u * static_cast<double>(window.columns - 1),
           static_cast<double>(window.row) + v * static_cast<double>(window.rows - 1)});
    }
  }
  Eigen::Vector3d low = Eigen::Vector3d::Constant(INFINITY);
  Eigen::Vector3d high = -low;
  for (const Plumb& plumb : world.plumbs(probes)) {
    for (const double height_m : {heights.min_height_m, heights.max_height_m}) {
      const Eigen::Vector3d at = plumb.base + height_m * plumb.up;
      low = low.cwiseMin(at);
      high = high.cwiseMax(at);
    }
  }
  return high - low;
}

/// The smallest power of two of which extent_m has at most \p steps.
double smallest_step(double extent_m, double steps) {
  return std::exp2(std::ceil(std::log2(extent_m / steps)));
}

double leaf_step(double extent_m, double largest_m) {
  // a flat DEM has no relief at all, but wants a step
  constexpr double kFinestStep_m = 1.0 / 1024;
  const double step_m =
      std::min(smallest_step(extent_m, kEnoughSteps), std::exp2(std::floor(std::log2(largest_m))));
  return std::max({kFinestStep_m, step_m, smallest_step(extent_m, Lattice::kMostSteps)});
}

std::int64_t halve_up(std::int64_t value, std::int64_t ratio) {
  // floor((value + ratio / 2) / ratio), also below zero; ratio is a power of two
  const std::int64_t shifted = value + ratio / 2;
  return shifted >= 0 ? shifted / ratio : -((-shifted + ratio - 1) / ratio);
}

}  // namespace

Lattice::Lattice(const Pyramid& pyramid, const WorldFrame& world, const HeightStatistics& heights,
                 double tolerance_m, double steps_per_tolerance) {
  for (int level = 0; level < pyramid.level_count(); ++level) {
    Eigen::Vector3d largest = Eigen::Vector3d::Zero();
    for (const TileId& tile : pyramid.tiles(level)) {
      largest = largest.cwiseMax(extent(pyramid, world, tile, heights));
    }
    largest.x() = largest.y() = std::max(largest.x(), largest.y());
    Eigen::Vector3d step_m;
    for (int axis = 0; axis < 3; ++axis) {
      step_m[axis] = level == 0 ? leaf_step(largest[axis], tolerance_m / steps_per_tolerance)
                                : std::max(steps_m_[level - 1][axis],
                                           smallest_step(largest[axis], kMostSteps));
    }
    steps_m_.push_back(step_m);
  }
}

LatticePoint Lattice::nearest(const Eigen::Vector3d& world, int level) const {
  const Eigen::Vector3d& step = steps_m_[level];
  const auto round = [](double steps) {
    return static_cast<std::int64_t>(std::floor(steps + 0.5));
  };
  return {round(world.x() / step.x()), round(world.y() / step.y()), round(world.z() / step.z())};
}

double Lattice::smallest_altitude_steps() const {
  // where the next level's steps are twice as wide, rounding moves a vertex by up to 0.71 of them,
  // both ends of an altitude together by 2.9 steps of this level
  return 4;
}

LatticePoint Lattice::of_sample(GridPosition /*sample*/, const Plumb& plumb, double height_m,
                                int level) const {
  return nearest(plumb.base + height_m * plumb.up, level);
}

LatticePoint Lattice::nearest_over_grid(const OverGrid& /*place*/, int /*level*/) const {
  assert(false);
  return {};
}

Eigen::Vector3d Lattice::world(const LatticePoint& point, int level) const {
  const Eigen::Vector3d& step = steps_m_[level];
  return {static_cast<double>(point.i) * step.x(), static_cast<double>(point.j) * step.y(),
          static_cast<double>(point.k) * step.z()};
}

std::array<std::int64_t, 3> Lattice::ratio(int level) const {
  const Eigen::Vector3d r = steps_m_[level + 1].cwiseQuotient(steps_m_[level]);
  return {static_cast<std::int64_t>(r.x()), static_cast<std::int64_t>(r.y()),
          static_cast<std::int64_t>(r.z())};
}

LatticePoint Lattice::coarsen(const LatticePoint& point, int level) const {
  const auto r = ratio(level);
  return {halve_up(point.i, r[0]), halve_up(point.j, r[1]), halve_up(point.k, r[2])};
}

LatticePoint Lattice::refine(const LatticePoint& point, int level) const {
  const auto r = ratio(level);
  return {point.i * r[0], point.j * r[1], point.k * r[2]};
}

double steepest(const Lattice& lattice, const std::vector<double>& tolerance_m) {
  // half a step on both axes; a tenth is for rounding in height
  constexpr double kMoved_steps = 0.71, kShare = 0.9;
  double result = INFINITY;
  for (int level = 0; level + 1 < static_cast<int>(tolerance_m.size()); ++level) {
    const double step_m = lattice.step_m(level + 1).x();
    if (step_m == lattice.step_m(level).x()) continue;
    const double slack_m = tolerance_m[level + 1] - tolerance_m[level];
    result = std::min(result, kShare * slack_m / (kMoved_steps * step_m));
  }
  return result;
}

}  // namespace terrane::tiler

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/height_statistics.h"
#include "core/lattice_point.h"
#include "tiler/pyramid.h"
#include "tiler/tile/world_frame.h"

namespace terrane::tiler {

/// The world lattice: a step per axis and level, powers of two of metres, a level's steps whole
/// multiples of the finer level's.
class Lattice {
 public:
  /// Most steps that a tile spans on an axis: two bits less than a float holds, so that a viewer's
  /// sums of position and offset are exact a few tiles away.
  static constexpr double kMostSteps = 1 << 22;

  /// Chooses the steps: a sixteenth of the tolerance or a little less, but at least 4,096 along a
  /// leaf tile; finer ones cost bytes and save few triangles. Coarser levels keep them as long as
  /// kMostSteps allows: rounding a level anew moves its vertices, which steep triangles do not take
  /// well.
  /// \param steps_per_tolerance  at least; more where lines make triangles thin and steep.
  Lattice(const Pyramid& pyramid, const WorldFrame& world, const HeightStatistics& heights,
          double tolerance_m, double steps_per_tolerance = 16);

  /// \param steps_m  east, north, up for each level.
  explicit Lattice(std::vector<Eigen::Vector3d> steps_m) : steps_m_(std::move(steps_m)) {}
  virtual ~Lattice() = default;

  int level_count() const { return static_cast<int>(steps_m_.size()); }
  const Eigen::Vector3d& step_m(int level) const { return steps_m_[level]; }

  /// The nearest lattice point; halves go up, so that the answer depends on the place alone.
  LatticePoint nearest(const Eigen::Vector3d& world, int level) const;
  virtual Eigen::Vector3d world(const LatticePoint& point, int level) const;

  /// Smallest altitude of a triangle in plan that rounding at the next level does not spoil.
  virtual double smallest_altitude_steps() const;

  /// Where a sample that tiles share is written: a function of the sample alone.
  virtual LatticePoint of_sample(GridPosition sample, const Plumb& plumb, double height_m,
                                 int level) const;

  /// A place over the grid (from the first sample of all) and over the ellipsoid.
  struct OverGrid {
    GridPosition at;
    double height_m = 0;
  };
  /// Where a point stands over the grid, if the lattice is one of parts of cells; else the world
  /// has to be asked.
  virtual std::optional<OverGrid> over_grid(const LatticePoint& /*point*/, int /*level*/) const {
    return std::nullopt;
  }
  /// \pre over_grid() has answers.
  virtual LatticePoint nearest_over_grid(const OverGrid& place, int level) const;

  /// The nearest point of the next level.
  LatticePoint coarsen(const LatticePoint& point, int level) const;
  /// A point of the next level in the steps of this one. Exact.
  LatticePoint refine(const LatticePoint& point, int level) const;

 private:
  std::array<std::int64_t, 3> ratio(int level) const;

  std::vector<Eigen::Vector3d> steps_m_;
};

/// Most metres that a triangle may rise over one metre of plan, so that where a level is rounded to
/// longer steps than the finer one, it comes not nearer to its tolerance than that is wider.
/// Infinite if no level is.
/// \param tolerance_m  of each level.
double steepest(const Lattice& lattice, const std::vector<double>& tolerance_m);

}  // namespace terrane::tiler

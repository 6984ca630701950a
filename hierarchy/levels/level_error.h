#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "hierarchy/levels/level_sequence.h"

namespace terrane::hierarchy {

/// How far a level is from M_0.
struct LevelError {
  double max = 0;  ///< largest distance of a vertex of M_0 from the level's surface, exact
  double rms = 0;  ///< root of the mean square of those distances
  /// Height fields only: the same along z, over the vertices of M_0 that the level covers in plan.
  struct Vertical {
    double max = 0, rms = 0;
    std::uint32_t uncovered = 0;  ///< vertices of M_0 under no triangle of the level
    std::uint32_t folded = 0;     ///< triangles that do not face the way M_0's do
  };
  std::optional<Vertical> vertical;
};

/// Measures the levels of one sequence against its M_0, in the unit of the mesh.
class LevelErrorMeter {
 public:
  /// \param sequence  must outlive the meter.
  explicit LevelErrorMeter(const LevelSequence& sequence);
  ~LevelErrorMeter();

  /// \param level  of \p mesh, which is M_level as LevelRebuilder::mesh() gives it.
  LevelError measure(const SurfaceMesh& mesh, std::uint32_t level) const;

  const SurfaceMesh& finest() const { return finest_; }

 private:
  class PlanGrid;
  void add_distances(const SurfaceMesh& mesh, std::uint32_t level, LevelError& error) const;

  const LevelSequence& sequence_;
  SurfaceMesh finest_;
  std::unique_ptr<const PlanGrid> plan_;  // of the vertices of M_0, if it is a height field
};

/// The vertex of M_level that each vertex of M_0 was collapsed into.
std::vector<std::uint32_t> representatives(const LevelSequence& sequence, std::uint32_t level);

/// Squared distance of a point from a triangle.
double squared_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                        const Eigen::Vector3d& b, const Eigen::Vector3d& c);

}  // namespace terrane::hierarchy

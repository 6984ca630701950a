#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tiler/verify/coverage.h"
#include "tiler/verify/placed_mesh.h"
#include "tiler/verify/sample_block.h"
#include "tiler/verify/water_shores.h"
#include "tiler/verify/world.h"

namespace terrane::verify {

/// The water that tiles are held against: polygons as their files have them.
class WaterJudge {
 public:
  /// \param farthest_m  the largest tolerance of any level.
  WaterJudge(const World& world, const Georeference& place, std::span<const WaterArea> areas,
             double farthest_m);

  /// Where the samples of a block lie.
  std::vector<WaterShores::Place> find(const SampleBlock& block) const;

  /// Triangles of water with a corner that is not as high as a body of water there, to what
  /// rounding to the lattice may do; or where there is none within the tolerance.
  std::int64_t count_uneven(const PlacedMesh& mesh, const Eigen::Vector3d& step_m,
                            double tolerance_m) const;

 private:
  const World& world_;
  std::vector<WaterArea> areas_;
  WaterShores shores_;
};

/// Is a sample clearly in water but under land alone, or clearly on land but under water alone?
/// Shores may lie off their place by the tolerance.
bool is_on_wrong_side(const Verdict& verdict, const WaterShores::Place& place, double tolerance_m);

}  // namespace terrane::verify

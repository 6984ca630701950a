#pragma once

#include "peer.h"

namespace terrane::peers {

struct Verdict {
  double max_m = 0;            ///< over the covered samples
  double rms_m = 0;            ///< over the covered samples
  std::int64_t uncovered = 0;  ///< samples under no triangle
  std::int64_t folded = 0;     ///< triangles without area in plan, or turned over
};

/// Measures any mesh: the vertical distance at every sample. Shares no code with terrane's engine.
///
/// A sample within 10^-6 cells of a triangle counts as under it; of several distances at a sample
/// the largest counts.
Verdict judge(const PeerMesh& mesh, const HeightGrid& grid);

}  // namespace terrane::peers

#pragma once

#include <map>
#include <optional>

#include "mesh_judge.h"
#include "peer.h"

namespace terrane::peers {

/// One run of a peer, measured.
struct Run {
  std::size_t triangles = 0;
  Verdict verdict;
  double cpu_s = 0;
};

/// Finds the fewest triangles with which a peer that knows no tolerance is within one.
///
/// Tries counts in steps of 1.6 down to 1,000, then halves the step below the last that holds until
/// it is below 1 %. The error of such
/// a peer need not fall with every triangle more, so the answer is the best that was seen. Runs are
/// kept: the next tolerance begins with what is known.
class CountSearch {
 public:
  CountSearch(const Peer& peer, const Terrain& terrain) : peer_(peer), terrain_(terrain) {}

  /// \return nothing if no count below that of the full terrain is within the tolerance.
  std::optional<Run> fewest_within(double tolerance_m);

 private:
  const Run& run(std::size_t count);

  const Peer& peer_;
  const Terrain& terrain_;
  std::map<std::size_t, Run> runs_;
};

}  // namespace terrane::peers

#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/height_source.h"

namespace terrane::peers {

using Triangle = std::array<std::uint32_t, 3>;

/// A mesh over the grid, whoever made it.
struct PeerMesh {
  std::vector<std::array<double, 3>> points;  ///< column and row in cells, height in metres
  std::vector<Triangle> triangles;            ///< all of one orientation in plan
};

/// The terrain that every peer gets: all its samples have data.
struct Terrain {
  const HeightSource& source;
  HeightGrid grid;
  double column_m, row_m;  ///< distance of neighbouring samples
  PeerMesh full;           ///< two triangles a cell
};

/// What a peer made, and the CPU time of it alone.
struct Answer {
  PeerMesh mesh;
  double cpu_s = 0;
};

/// Somebody's simplifier in one setting. Of the settings of one name, the best is shown.
struct Peer {
  std::string name;
  std::string setting;  ///< empty for the only one
  /// For those that take a tolerance and keep it in their own way.
  std::function<std::optional<Answer>(const Terrain&, double tolerance_m)> by_tolerance;
  /// For those that take a number of triangles instead.
  std::function<Answer(const Terrain&, std::size_t triangles)> by_count;
};

std::vector<Peer> terrane_peers();
std::vector<Peer> meshoptimizer_peers();
std::vector<Peer> openmesh_peers();
std::vector<Peer> cgal_peers();
/// delatin and martini, run by node; none where they are not installed.
std::vector<Peer> node_peers();

/// CPU seconds of this process so far.
double cpu_s();

}  // namespace terrane::peers

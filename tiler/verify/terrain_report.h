#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace terrane::verify {

/// What can be wrong with a set of terrain tiles. Each has a column of its own in the report.
enum class TerrainFault {
  kMissing,     ///< listed (or a root), but no such file; or no parent
  kUnexpected,  ///< there, but not listed
  kUnreadable,  ///< no whole quantized-mesh or glb
  kIndices,     ///< beyond the high-water mark, or a vertex that no triangle uses
  kFolded,      ///< triangles that face down or have no area
  kCover,       ///< tiles whose triangles do not cover them once
  kEdgeLists,   ///< lists of border vertices that are not those on the border
  kBorders,     ///< vertices that two neighbours do not share
  kHeights,     ///< a minimum that no vertex has, a maximum (far) above the highest
  kSpheres,     ///< bounding spheres that lack a vertex
  kHorizon,     ///< occlusion points that are hidden while a vertex is seen
  kNormals,     ///< missing, or not upward
  kWater,       ///< masks of a wrong size or with a wrong value
  kMetadata,    ///< availability of a tile that is not that of layer.json
  kMisstated,   ///< counts and errors in terrane.json, facts in layer.json or tileset.json
};
inline constexpr std::size_t kTerrainFaults = 15;
std::string name_of(TerrainFault fault);

/// What was found on one zoom.
struct TerrainZoomReport {
  int zoom = 0;
  double tolerance_m = 0;       ///< as terrane.json states it
  bool is_held_to_dem = false;  ///< as terrane.json states it: else errors are told, not judged
  std::int64_t tiles = 0, triangles = 0, bytes = 0;

  /// |mesh - DEM| along the ellipsoid's normal at the DEM's own samples.
  double max_error_m = 0, rms_error_m = 0;
  std::int64_t samples = 0;
  std::int64_t uncovered_samples = 0;       ///< no tile is there, or it has no triangle there
  std::int64_t samples_over_tolerance = 0;  ///< zero where the zoom is not held to the DEM
  std::int64_t border_vertices = 0;         ///< compared between neighbours

  std::array<std::int64_t, kTerrainFaults> faults{};

  bool holds() const;
};

/// The verdict on a set of terrain tiles.
struct TerrainReport {
  std::vector<TerrainZoomReport> zooms;  ///< from 0
  std::vector<std::string> problems;     ///< one line each; not all if many
  std::int64_t problems_left_out = 0;

  bool holds() const;
};

/// Tables for a terminal, the problems below them. Ends with a newline.
std::string to_text(const TerrainReport& report);

/// The whole report as a JSON object, with the key "holds".
std::string to_json(const TerrainReport& report);

}  // namespace terrane::verify

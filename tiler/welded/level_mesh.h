#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace terrane::welded {

using Position = std::array<double, 3>;  ///< metres: x east, y north, z up
using Triangle = std::array<std::uint32_t, 3>;

/// Triangles over shared vertices, counter-clockwise seen from above.
struct SurfaceMesh {
  std::vector<Position> positions;
  std::vector<Triangle> triangles;
};

/// Part of the Earth, in degrees; in metres of the DEM's plane where that has no CRS. west > east
/// spans the antimeridian.
struct Area {
  double west = 0;
  double south = 0;
  double east = 0;
  double north = 0;
};

/// Where x = y = z = 0 lies.
struct Origin {
  bool is_local = false;
  double longitude_deg = 0;
  double latitude_deg = 0;
  double x_m = 0;  ///< of a DEM without CRS
  double y_m = 0;
};

/// All tiles of one level as one mesh.
struct LevelMesh {
  int level = 0;
  double tolerance_m = 0;
  double max_error_m = 0;
  Origin origin;
  SurfaceMesh surface;
};

/// Number of levels of an output folder.
/// \throws InputError if it is no finished output.
int level_count(const std::filesystem::path& folder);

/// Joins the tiles of a level. Vertices of neighbouring tiles are the same integers on the world
/// lattice, and become one: no seams, no duplicates. Positions are exact.
///
/// \param area  cuts out this part: triangles across its border are divided there, and edges of
///              neighbours at the same place, so the cut is as tight as the rest.
/// \throws InputError if the folder is no finished output, a tile is damaged, or nothing lies in
/// the
///         area; ConfigError if there is no such level or the area is empty.
LevelMesh weld_level(const std::filesystem::path& folder, int level,
                     const std::optional<Area>& area);

}  // namespace terrane::welded

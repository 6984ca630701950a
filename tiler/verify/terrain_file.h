#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace terrane::verify {

/// A quantized-mesh tile as its bytes say, decoded but not judged.
struct TerrainFile {
  std::array<double, 3> centre{};
  float min_height_m = 0, max_height_m = 0;
  std::array<double, 3> sphere_centre{};
  double sphere_radius_m = 0;
  std::array<double, 3> horizon{};  ///< in the space in which the ellipsoid is the unit sphere

  std::vector<std::int32_t> u, v, height;  ///< as decoded, 0 to 32767 if all is well
  std::vector<std::array<std::uint32_t, 3>> triangles;
  bool has_sound_indices = true;  ///< the high-water mark was never passed

  enum Side { kWest, kSouth, kEast, kNorth };
  std::array<std::vector<std::uint32_t>, 4> border;

  std::optional<std::string> normals, water, metadata;  ///< metadata: the JSON alone
  std::int64_t bytes = 0;                               ///< on disk

  /// Metres over the ellipsoid as clients interpolate between minimum and maximum.
  double height_m(std::uint32_t vertex) const;
};

/// Reads a gzipped tile.
/// \throws InputError that names the file if it is missing, not gzip, cut short, or goes on after
///         its last extension.
/// \par Source
/// https://github.com/CesiumGS/quantized-mesh
TerrainFile read_terrain_file(const std::filesystem::path& file);

}  // namespace terrane::verify

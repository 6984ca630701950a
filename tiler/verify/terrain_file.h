#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace terrane::verify {

/// A terrain tile as its bytes say, decoded but not judged.
struct TerrainFile {
  double min_height_m = 0, max_height_m = 0;
  std::array<double, 3> sphere_centre{};
  double sphere_radius_m = 0;
  std::array<double, 3> horizon{};  ///< in the space in which the ellipsoid is the unit sphere

  /// Eastward and northward from the south-west corner: 0 to 32767 if all is well, and whole in
  /// quantized-mesh.
  std::vector<double> u, v;
  std::vector<double> height_m;             ///< over the ellipsoid
  std::vector<std::int32_t> height_steps;   ///< of quantized-mesh alone: 0 to 32767 if all is well
  std::vector<Eigen::Vector3d> glb_ecef_m;  ///< of a glb alone: the places that it states
  std::vector<std::array<std::uint32_t, 3>> triangles;
  bool has_sound_indices = true;  ///< the high-water mark was never passed

  enum Side { kWest, kSouth, kEast, kNorth };
  std::array<std::vector<std::uint32_t>, 4> border;

  std::vector<Eigen::Vector3d> normals;        ///< Earth-centred; not as many as vertices: damaged
  std::optional<std::string> water, metadata;  ///< of quantized-mesh; metadata: the JSON alone
  std::int64_t bytes = 0;                      ///< on disk
};

inline constexpr TerrainFile::Side kTerrainSides[] = {TerrainFile::kWest, TerrainFile::kSouth,
                                                      TerrainFile::kEast, TerrainFile::kNorth};

/// Reads a gzipped quantized-mesh tile.
/// \throws InputError that names the file if it is missing, not gzip, cut short, or goes on after
///         its last extension.
/// \par Source
/// https://github.com/CesiumGS/quantized-mesh
TerrainFile read_terrain_file(const std::filesystem::path& file);

}  // namespace terrane::verify

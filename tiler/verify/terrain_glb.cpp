#include "tiler/verify/terrain_glb.h"

#include <GeographicLib/Geocentric.hpp>
#include <cmath>

#include "core/errors.h"
#include "tiler/verify/glb.h"

namespace terrane::verify {
namespace {

using nlohmann::json;

constexpr double kLast = 32767;

/// What the node's matrix makes of a vector, once glTF's y is turned up to the Earth's z.
Eigen::Vector3d placed(const Eigen::Matrix4d& matrix, const Glb::Vector& at, double w) {
  const Eigen::Vector4d moved = matrix * Eigen::Vector4d(at[0], at[1], at[2], w);
  return {moved.x(), -moved.z(), moved.y()};
}

Eigen::Matrix4d matrix_of(const json& node) {
  const auto numbers = node.at("matrix").get<std::array<double, 16>>();
  return Eigen::Map<const Eigen::Matrix4d>(numbers.data());  // both by columns
}

void take_places(const TerrainKey& key, TerrainFile& tile) {
  for (const Eigen::Vector3d& at : tile.glb_ecef_m) {
    double latitude_deg = 0, longitude_deg = 0, height_m = 0;
    GeographicLib::Geocentric::WGS84().Reverse(at.x(), at.y(), at.z(), latitude_deg, longitude_deg,
                                               height_m);
    const double east_deg =
        std::remainder(longitude_deg - key.west_deg() - key.side_deg() / 2, 360.0);
    tile.u.push_back((east_deg / key.side_deg() + 0.5) * kLast);
    tile.v.push_back((latitude_deg - key.south_deg()) / key.side_deg() * kLast);
    tile.height_m.push_back(height_m);
  }
}

/// Calls set(vertex) for those of a border list that there are.
template <class Set>
void for_each_listed(TerrainFile& tile, TerrainFile::Side side, const Set& set) {
  for (const std::uint32_t v : tile.border[side]) {
    if (v < tile.u.size()) set(v);
  }
}

void settle_pole(TerrainFile& tile, TerrainFile::Side side) {
  std::vector<bool> is_at_pole(tile.u.size(), false);
  for_each_listed(tile, side, [&](std::uint32_t v) { is_at_pole[v] = true; });
  std::vector<double> sum(tile.u.size(), 0), count(tile.u.size(), 0);
  for (const auto& corners : tile.triangles) {
    for (const std::uint32_t a : corners) {
      for (const std::uint32_t b : corners) {
        if (a >= tile.u.size() || b >= tile.u.size() || !is_at_pole[a] || is_at_pole[b]) continue;
        sum[a] += tile.u[b];
        ++count[a];
      }
    }
  }
  for_each_listed(tile, side, [&](std::uint32_t v) {
    tile.u[v] = count[v] > 0 ? sum[v] / count[v] : kLast / 2;
  });
}

}  // namespace

bool is_pole(const TerrainKey& key, TerrainFile::Side side) {
  return (side == TerrainFile::kSouth && key.y == 0) ||
         (side == TerrainFile::kNorth && key.y + 1 == std::int64_t{1} << key.zoom);
}

TerrainFile read_terrain_glb(const std::filesystem::path& file, const TerrainKey& key,
                             const TerrainFacts& facts) {
  const Glb glb = Glb::read(file);
  TerrainFile tile;
  tile.min_height_m = facts.min_height_m;
  tile.max_height_m = facts.max_height_m;
  tile.sphere_centre = facts.sphere_centre;
  tile.sphere_radius_m = facts.sphere_radius_m;
  tile.horizon = facts.horizon;
  tile.bytes = glb.bytes();
  try {
    const json& document = glb.document();
    const json& meshes = document.at("meshes");
    if (meshes.size() != 1 || meshes[0].at("primitives").size() != 1 ||
        document.at("nodes").size() != 1) {
      glb.fail("has not one node, one mesh and one primitive");
    }
    const json& primitive = meshes[0]["primitives"][0];
    const Eigen::Matrix4d matrix = matrix_of(document["nodes"][0]);
    for (const auto& at : glb.vectors(primitive, "POSITION")) {
      tile.glb_ecef_m.push_back(placed(matrix, at, 1));
    }
    for (const auto& normal : glb.vectors(primitive, "NORMAL")) {
      tile.normals.push_back(placed(matrix, normal, 0));
    }
    const std::vector<std::uint32_t> indices = glb.indices(primitive);
    if (indices.size() % 3 != 0) glb.fail("has no whole triangles");
    for (std::size_t k = 0; k < indices.size(); k += 3) {
      tile.triangles.push_back({indices[k], indices[k + 1], indices[k + 2]});
    }
    const json& edges = primitive.at("extensions").at("CESIUM_tile_edges");
    constexpr const char* kNames[] = {"left", "bottom", "right", "top"};
    for (const TerrainFile::Side side : kTerrainSides) {
      tile.border[side] = glb.whole_numbers(edges.at(kNames[side]));
    }
  } catch (const json::exception& error) {
    glb.fail(error.what());
  }
  take_places(key, tile);
  for (const TerrainFile::Side side : {TerrainFile::kSouth, TerrainFile::kNorth}) {
    if (is_pole(key, side)) settle_pole(tile, side);
  }
  for_each_listed(tile, TerrainFile::kWest, [&](std::uint32_t v) { tile.u[v] = 0; });
  for_each_listed(tile, TerrainFile::kEast, [&](std::uint32_t v) { tile.u[v] = kLast; });
  for_each_listed(tile, TerrainFile::kSouth, [&](std::uint32_t v) { tile.v[v] = 0; });
  for_each_listed(tile, TerrainFile::kNorth, [&](std::uint32_t v) { tile.v[v] = kLast; });
  return tile;
}

}  // namespace terrane::verify

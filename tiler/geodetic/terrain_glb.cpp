#include "tiler/geodetic/terrain_glb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "tiler/gltf/glb_buffers.h"
#include "tiler/gltf/pack_glb.h"

namespace terrane::tiler {
namespace {

using nlohmann::ordered_json;

constexpr const char* kTileEdges = "CESIUM_tile_edges";

/// glTF's y is up: north of the Earth, as clients turn it.
Eigen::Vector3f y_up(const Eigen::Vector3f& v) { return {v.x(), v.z(), -v.y()}; }

GlbValues values_of(const std::vector<Eigen::Vector3f>& vectors, bool has_bounds) {
  GlbValues values{.component = Component::kFloat,
                   .components = 3,
                   .count = vectors.size(),
                   .stride = sizeof(Eigen::Vector3f)};
  values.bytes.assign(reinterpret_cast<const char*>(vectors.data()),
                      vectors.size() * sizeof(Eigen::Vector3f));
  if (!has_bounds) return values;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto [low, high] =
        std::ranges::minmax(vectors, {}, [&](const Eigen::Vector3f& v) { return v[axis]; });
    values.low.push_back(low[axis]);
    values.high.push_back(high[axis]);
  }
  return values;
}

Eigen::Vector3d rounded(const Eigen::Vector3d& at, double step_m) {
  // halves go away from 0 on both sides, so turning an axis changes nothing
  return (at / step_m).unaryExpr([](double steps) { return std::round(steps); }) * step_m;
}

}  // namespace

double place_step_m(int zoom, double height_range_m) {
  constexpr double kEquator_m = 6378137;
  const double side_m = std::ldexp(std::numbers::pi * kEquator_m, -zoom);
  return std::exp2(std::ceil(std::log2(side_m + height_range_m)) - 24);
}

std::vector<Eigen::Vector3d> glb_places_of(const TerrainTile& tile, double step_m) {
  std::vector<Eigen::Vector3d> places = ecef_of(tile);
  for (Eigen::Vector3d& at : places) at = rounded(at, step_m);
  return places;
}

std::string encode_terrain_glb(const TerrainTile& given, double step_m,
                               const std::string& attribution) {
  const TerrainTile tile = in_order_of_use(given);
  const std::vector<Eigen::Vector3d> places = glb_places_of(tile, step_m);
  const Eigen::Vector3d middle = rounded(sphere_around(places).centre, step_m);
  std::vector<Eigen::Vector3f> positions, normals;
  for (const Eigen::Vector3d& at : places) positions.push_back(y_up((at - middle).cast<float>()));
  for (const Eigen::Vector3f& normal : tile.normals) normals.push_back(y_up(normal.normalized()));
  std::vector<std::uint32_t> indices;
  for (const auto& corners : tile.triangles) {
    indices.insert(indices.end(), corners.begin(), corners.end());
  }

  GlbBuffers buffers(/*is_meshopt=*/false);
  ordered_json primitive;
  primitive["attributes"]["POSITION"] = buffers.add_vertices(values_of(positions, true));
  primitive["attributes"]["NORMAL"] = buffers.add_vertices(values_of(normals, false));
  primitive["indices"] = buffers.add_triangles(indices, tile.vertices.size());
  primitive["material"] = 0;
  const TerrainBorders borders = borders_of(tile);
  ordered_json& edges = primitive["extensions"][kTileEdges];
  edges["left"] = buffers.add_triangles(borders.west, tile.vertices.size());
  edges["bottom"] = buffers.add_triangles(borders.south, tile.vertices.size());
  edges["right"] = buffers.add_triangles(borders.east, tile.vertices.size());
  edges["top"] = buffers.add_triangles(borders.north, tile.vertices.size());

  ordered_json json;
  json["asset"] = {{"version", "2.0"}, {"generator", TERRANE_GENERATOR}};
  if (!attribution.empty()) json["asset"]["copyright"] = attribution;
  json["extensionsUsed"] = ordered_json::array({kTileEdges});
  json["scene"] = 0;
  json["scenes"][0]["nodes"] = std::vector<int>{0};
  const std::array<double, 16> place{1, 0, 0, 0, 0,          1,          0,           0,
                                     0, 0, 1, 0, middle.x(), middle.z(), -middle.y(), 1};
  json["nodes"][0]["mesh"] = 0;
  json["nodes"][0]["matrix"] = place;
  json["meshes"][0]["primitives"][0] = primitive;
  ordered_json& surface = json["materials"][0]["pbrMetallicRoughness"];
  surface["baseColorFactor"] = std::vector<double>{0.62, 0.6, 0.55, 1};
  surface["metallicFactor"] = 0;
  surface["roughnessFactor"] = 1;
  json["accessors"] = buffers.accessors();
  json["bufferViews"] = buffers.views();
  json["buffers"] = buffers.buffers();
  return pack_glb(json.dump(), buffers.bytes());
}

}  // namespace terrane::tiler

#include "tiler/geodetic/terrain_tile.h"

#include <meshoptimizer.h>

#include <GeographicLib/Geocentric.hpp>
#include <algorithm>
#include <cstring>

#include "core/errors.h"
#include "tiler/files/whole_file.h"
#include "tiler/geodetic/grid_lattice.h"

namespace terrane::tiler {
namespace {

/// The vertices on one border, in order along it.
template <class On, class Along>
std::vector<std::uint32_t> border_of(const TerrainTile& tile, On is_on, Along along) {
  std::vector<std::uint32_t> border;
  for (std::uint32_t v = 0; v < tile.vertices.size(); ++v) {
    if (is_on(tile.vertices[v])) border.push_back(v);
  }
  std::ranges::sort(border, {}, [&](std::uint32_t v) { return along(tile.vertices[v]); });
  return border;
}

}  // namespace

std::vector<Eigen::Vector3d> ecef_of(const TerrainTile& tile) {
  const TmsBounds bounds = bounds_of(tile.tile);
  std::vector<Eigen::Vector3d> ecef;
  ecef.reserve(tile.vertices.size());
  for (const TerrainTile::Vertex& vertex : tile.vertices) {
    const auto part = [](std::int32_t step, double from, double to) {
      return from + (to - from) * step / static_cast<double>(kTileSteps);
    };
    Eigen::Vector3d& at = ecef.emplace_back();
    GeographicLib::Geocentric::WGS84().Forward(
        part(vertex.v, bounds.south_deg, bounds.north_deg),
        part(vertex.u, bounds.west_deg, bounds.east_deg),
        static_cast<double>(vertex.height) * tile.height_step_m, at.x(), at.y(), at.z());
  }
  return ecef;
}

TerrainTile in_order_of_use(const TerrainTile& tile) {
  std::vector<std::uint32_t> indices;
  for (const auto& corners : tile.triangles) {
    indices.insert(indices.end(), corners.begin(), corners.end());
  }
  meshopt_optimizeVertexCache(indices.data(), indices.data(), indices.size(), tile.vertices.size());
  std::vector<std::uint32_t> remap(tile.vertices.size());
  const std::size_t used = meshopt_optimizeVertexFetchRemap(remap.data(), indices.data(),
                                                            indices.size(), tile.vertices.size());
  TerrainTile ordered = tile;
  ordered.vertices.resize(used);
  ordered.normals.resize(used);
  for (std::size_t v = 0; v < remap.size(); ++v) {
    if (remap[v] == ~std::uint32_t{0}) continue;
    ordered.vertices[remap[v]] = tile.vertices[v];
    ordered.normals[remap[v]] = tile.normals[v];
  }
  for (std::size_t t = 0; t < ordered.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) ordered.triangles[t][k] = remap[indices[3 * t + k]];
  }
  return ordered;
}

TerrainBorders borders_of(const TerrainTile& tile) {
  using Vertex = TerrainTile::Vertex;
  const auto eastward = [](const Vertex& a) { return a.u; };
  const auto westward = [](const Vertex& a) { return -a.u; };
  const auto northward = [](const Vertex& a) { return a.v; };
  const auto southward = [](const Vertex& a) { return -a.v; };
  return {.west = border_of(
              tile, [](const Vertex& a) { return a.u == 0; }, northward),
          .north = border_of(
              tile, [](const Vertex& a) { return a.v == kTileSteps; }, eastward),
          .east = border_of(
              tile, [](const Vertex& a) { return a.u == kTileSteps; }, southward),
          .south = border_of(
              tile, [](const Vertex& a) { return a.v == 0; }, westward)};
}

TerrainFacts facts_of(const TerrainTile& tile, std::span<const Eigen::Vector3d> ecef) {
  const auto [low, high] =
      std::ranges::minmax(tile.vertices, {}, [](const auto& vertex) { return vertex.height; });
  const TmsBounds bounds = bounds_of(tile.tile);
  Eigen::Vector3d middle;
  GeographicLib::Geocentric::WGS84().Forward((bounds.south_deg + bounds.north_deg) / 2,
                                             (bounds.west_deg + bounds.east_deg) / 2, 0, middle.x(),
                                             middle.y(), middle.z());
  return {.min_height_m = static_cast<double>(low.height) * tile.height_step_m,
          .max_height_m = static_cast<double>(high.height) * tile.height_step_m,
          .sphere = sphere_around(ecef),
          .horizon = horizon_occlusion_point(ecef, middle)};
}

void write_facts(const TerrainFacts& facts, const std::filesystem::path& file) {
  const double numbers[] = {
      facts.min_height_m,      facts.max_height_m,      facts.sphere.centre.x(),
      facts.sphere.centre.y(), facts.sphere.centre.z(), facts.sphere.radius_m,
      facts.horizon.x(),       facts.horizon.y(),       facts.horizon.z()};
  write_whole_file(file, std::string(reinterpret_cast<const char*>(numbers), sizeof numbers));
}

TerrainFacts read_facts(const std::filesystem::path& file) {
  const std::string bytes = read_whole_file(file);
  std::array<double, 9> n{};
  if (bytes.size() != sizeof n) {
    throw InputError(file.string() + ": is damaged. Remove the output folder and build again");
  }
  std::memcpy(n.data(), bytes.data(), sizeof n);
  return {n[0], n[1], {{n[2], n[3], n[4]}, n[5]}, {n[6], n[7], n[8]}};
}

}  // namespace terrane::tiler

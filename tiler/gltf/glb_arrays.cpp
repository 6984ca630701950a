#include "tiler/gltf/glb_arrays.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "core/errors.h"
#include "tiler/gltf/ground_colour.h"

namespace terrane::tiler {
namespace {

/// A mesh on some of the tile's vertices.
struct Part {
  std::span<const LatticePoint> points;
  std::span<const LatticePoint> targets;
  std::span<const std::uint32_t> vertices;  ///< of the tile: has their normals and grounds
  std::span<const hierarchy::Corners> triangles;
  std::span<const std::uint8_t> in_water;  ///< of each triangle; may be empty
};

// the filter's mantissas have 24 bits, and floats hold every integer of that size
constexpr std::int64_t kMostSteps = (1 << 23) - 1;

std::int32_t step_of(std::int64_t value, const TileId& tile) {
  if (std::abs(value) > kMostSteps) {
    throw OutputError(fmt::format(
        "tile {}: spans more than 24 bits of lattice steps. This is a defect of terrane; please "
        "report it with the DEM's size and CRS",
        path_of(tile)));
  }
  return static_cast<std::int32_t>(value);
}

/// b - a in glTF's axes: x east, y up, z south.
Steps y_up(const LatticePoint& a, const LatticePoint& b, const TileId& tile) {
  return {step_of(b.i - a.i, tile), step_of(b.k - a.k, tile), step_of(a.j - b.j, tile)};
}

/// Normals are divided by the node's scale when drawn: multiply first.
Eigen::Vector3f stored_normal(const Eigen::Vector3f& normal, const Eigen::Vector3d& scale) {
  const Eigen::Vector3d n = normal.cast<double>().cwiseProduct(scale).normalized();
  return Eigen::Vector3d(n.x(), n.z(), -n.y()).cast<float>();
}

std::vector<std::uint32_t> cached_indices(const Part& part, bool is_water, bool is_mirrored) {
  std::vector<std::uint32_t> indices;
  for (std::size_t t = 0; t < part.triangles.size(); ++t) {
    if ((!part.in_water.empty() && part.in_water[t] != 0) != is_water) continue;
    auto [a, b, c] = part.triangles[t];
    if (is_mirrored) std::swap(b, c);
    indices.insert(indices.end(), {a, b, c});
  }
  // the order for strips serves a cache nearly as well, and its neighbours are nearer to each other
  meshopt_optimizeVertexCacheStrip(indices.data(), indices.data(), indices.size(),
                                   part.points.size());
  return indices;
}

GlbArrays arrange(const GlbTile& tile, const TileFormat& format, const Part& part, Cover cover) {
  GlbArrays arrays;
  if (cover != Cover::kWater) arrays.land = cached_indices(part, false, tile.is_mirrored);
  if (cover != Cover::kLand) arrays.water = cached_indices(part, true, tile.is_mirrored);
  std::vector<std::uint32_t> all(arrays.land);
  all.insert(all.end(), arrays.water.begin(), arrays.water.end());
  if (all.empty()) return arrays;
  std::vector<std::uint32_t> remap(part.points.size());
  const std::size_t count =
      meshopt_optimizeVertexFetchRemap(remap.data(), all.data(), all.size(), part.points.size());
  for (std::uint32_t& i : arrays.land) i = remap[i];
  for (std::uint32_t& i : arrays.water) i = remap[i];

  const bool is_scaled = format.positions == Positions::kLattice;
  const Eigen::Vector3d scale = is_scaled ? tile.step_m : Eigen::Vector3d::Ones();
  const LatticePoint origin = origin_of(tile.mesh);
  std::vector<Steps> positions(count), morphs(count);
  std::vector<Eigen::Vector3f> normals(count);
  std::vector<Eigen::Vector2f> places(tile.texture.is_there() ? count : 0);
  std::vector<Colour4> colours(format.colour == Colour::kNone ? 0 : count);
  for (std::size_t v = 0; v < part.points.size(); ++v) {
    const std::uint32_t to = remap[v];
    if (to == ~std::uint32_t{0}) continue;
    positions[to] = y_up(origin, part.points[v], tile.id);
    morphs[to] = y_up(part.points[v], part.targets[v], tile.id);
    normals[to] = stored_normal(tile.mesh.normals[part.vertices[v]], scale);
    const Ground ground =
        places.empty() && colours.empty() ? Ground{} : tile.mesh.grounds[part.vertices[v]];
    if (!places.empty()) places[to] = tile.texture.place_of(ground);
    if (!colours.empty()) colours[to] = colour_of(format.colour, ground, tile.heights);
  }

  const std::array step_m{tile.step_m.x(), tile.step_m.z(), tile.step_m.y()};
  arrays.positions = values_of_steps(positions, format.positions, step_m);
  arrays.morphs = values_of_steps(morphs, format.positions, step_m);
  arrays.normals = values_of_normals(normals, !is_scaled);
  if (!arrays.water.empty()) {
    normals.assign(count, stored_normal(tile.up.cast<float>(), scale));
    arrays.upright = values_of_normals(normals, !is_scaled);
  }
  if (!places.empty()) arrays.places = values_of_places(places, !is_scaled);
  if (!colours.empty()) arrays.colours = values_of_colours(colours);
  return arrays;
}

}  // namespace

LatticePoint origin_of(const TileMesh& mesh) {
  LatticePoint low = mesh.points.front(), high = low;
  for (const LatticePoint& p : mesh.points) {
    low = {std::min(low.i, p.i), std::min(low.j, p.j), std::min(low.k, p.k)};
    high = {std::max(high.i, p.i), std::max(high.j, p.j), std::max(high.k, p.k)};
  }
  return {(low.i + high.i) / 2, (low.j + high.j) / 2, (low.k + high.k) / 2};
}

GlbArrays arrange_surface(const GlbTile& tile, const TileFormat& format, Cover cover) {
  const TileMesh& mesh = tile.mesh;
  std::vector<std::uint32_t> all(mesh.points.size());
  std::iota(all.begin(), all.end(), 0);
  return arrange(tile, format, {mesh.points, tile.targets, all, mesh.triangles, mesh.in_water},
                 cover);
}

GlbArrays arrange_skirt(const GlbTile& tile, const TileFormat& format, Cover cover) {
  const TileSkirt& skirt = tile.skirt;
  return arrange(tile, format,
                 {skirt.points, skirt.targets, skirt.above, skirt.triangles, skirt.in_water},
                 cover);
}

}  // namespace terrane::tiler

#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "hierarchy/mesh/halfedge_mesh.h"
#include "tiler/geodetic/horizon.h"
#include "tiler/geodetic/tile_band.h"

namespace terrane::tiler {

/// What a terrain tile of the geodetic quadtree is made of.
struct TerrainTile {
  TmsTile tile;
  /// u eastward and v northward, 0 to 32767 (GridLattice), and height in steps over the ellipsoid.
  struct Vertex {
    std::int32_t u = 0, v = 0;
    std::int64_t height = 0;
  };
  std::vector<Vertex> vertices;
  std::vector<Eigen::Vector3f> normals;       ///< unit, Earth-centred
  std::vector<hierarchy::Corners> triangles;  ///< counter-clockwise from above
  double height_step_m = 1;                   ///< a power of two
  std::string metadata;                       ///< JSON; empty: none
  std::string water;  ///< empty, one byte, or 256 x 256 from the north-west: 255 is water
};

/// Earth-centred positions of a tile's vertices, as a decoder of quantized-mesh has them.
std::vector<Eigen::Vector3d> ecef_of(const TerrainTile& tile);

/// Triangles in an order that a vertex cache likes, vertices in that of their first use.
TerrainTile in_order_of_use(const TerrainTile& tile);

/// The vertices on a tile's borders, clockwise: west from the south on, north from the west on,
/// east from the north on, south from the east on.
struct TerrainBorders {
  std::vector<std::uint32_t> west, north, east, south;
};
TerrainBorders borders_of(const TerrainTile& tile);

/// What clients are told of a tile to find out whether it is seen.
struct TerrainFacts {
  double min_height_m = 0, max_height_m = 0;
  Sphere sphere;
  Eigen::Vector3d horizon = Eigen::Vector3d::Zero();  ///< see horizon_occlusion_point()
};
/// \param ecef  the places of its vertices as clients get them.
TerrainFacts facts_of(const TerrainTile& tile, std::span<const Eigen::Vector3d> ecef);

/// \throws OutputError if the file cannot be written.
void write_facts(const TerrainFacts& facts, const std::filesystem::path& file);
/// \throws InputError if it is not there or cut short.
TerrainFacts read_facts(const std::filesystem::path& file);

}  // namespace terrane::tiler

#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "hierarchy/mesh/halfedge_mesh.h"
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

/// Minimum and maximum of a tile, and the number of its steps (a power of two) that make one
/// quantized step: decoders that interpolate between the two meet every height exactly.
struct HeightRange {
  float min_m = 0, max_m = 0;
  std::int64_t lowest = 0;    ///< in steps
  std::int64_t per_step = 1;  ///< quantized steps to one step
};
HeightRange height_range(const TerrainTile& tile);

/// Earth-centred positions of a tile's vertices, as a decoder has them.
std::vector<Eigen::Vector3d> ecef_of(const TerrainTile& tile);

/// Encodes a tile as quantized-mesh 1.0 with the extensions for normals and, if there are any,
/// water and metadata. Not compressed.
///
/// \pre every triangle has an area; u and v are from 0 to 32767.
/// \par Source
/// https://github.com/CesiumGS/quantized-mesh
std::string encode_quantized_mesh(const TerrainTile& tile);

}  // namespace terrane::tiler

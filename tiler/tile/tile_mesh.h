#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "core/lattice_point.h"
#include "hierarchy/mesh/border_place.h"
#include "hierarchy/mesh/halfedge_mesh.h"
#include "hierarchy/mesh/lined_triangles.h"
#include "tiler/tile/oriented_box.h"
#include "tiler/tile_id.h"

namespace terrane::tiler {

/// Measured vertical distances between a mesh and the samples under it.
struct MeasuredError {
  double max_m = 0;
  double sum_of_squares_m2 = 0;
  std::int64_t samples = 0;
};

/// Where a vertex stands on the DEM, for textures and colours.
struct Ground {
  float column = 0, row = 0;  ///< cells from the tile's first sample
  float height_m = 0;         ///< over the ellipsoid
  float slope = 0;            ///< cosine of the angle between normal and plumb line
};

/// A finished mesh of one tile at one level: just what the next level and the writer need.
struct TileMesh {
  std::vector<LatticePoint> points;             ///< on the lattice of the tile's level
  std::vector<hierarchy::BorderPlace> borders;  ///< of outline and seam vertices
  std::vector<float> water_m;                   ///< of vertices in water its height; else NaN
  std::vector<Eigen::Vector3f> normals;         ///< unit, in the world
  std::vector<Ground> grounds;
  std::vector<hierarchy::Corners> triangles;  ///< counter-clockwise with rows downward
  std::vector<std::uint8_t> in_water;         ///< of each triangle, 1 or 0; empty: none is
  std::vector<hierarchy::LineEdge> lines;     ///< edges that are parts of lines and shores
  MeasuredError error;
};

/// What is known of a written tile.
struct TileRecord {
  TileId tile;
  std::int64_t triangles = 0;
  std::int64_t skirt_triangles = 0;
  std::int64_t bytes = 0;
  MeasuredError error;  ///< max_m: at least the children's
  OrientedBox box;      ///< of the tile, its morphed places, its skirts and its children's boxes
};

/// A tile whose descendants are written: what a build keeps in its work folder to go on from.
struct FinishedTile {
  std::vector<TileRecord> descendants;
  TileMesh mesh;
};

/// \throws OutputError if the file cannot be written.
void write_finished_tile(const FinishedTile& tile, const std::filesystem::path& file);

/// \throws InputError if the file is not there or cut short.
FinishedTile read_finished_tile(const std::filesystem::path& file);

}  // namespace terrane::tiler

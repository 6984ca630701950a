#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tiler/verify/grid_locator.h"
#include "tiler/verify/tile_mesh.h"
#include "tiler/verify/world.h"

namespace terrane::verify {

/// A tile's mesh in the world, with the leaf blocks that each triangle may cover at any t.
class PlacedMesh {
 public:
  PlacedMesh(TileMesh mesh, const Output& output, const World& world);

  const TileMesh& mesh() const { return mesh_; }

  /// World place of a vertex at morph t; exact, as positions are integers and t a quarter.
  Eigen::Vector3d corner(std::uint32_t vertex, double t) const;

  /// Grid position of a vertex at t, good to a fraction of a cell.
  GridPosition grid_position(std::uint32_t vertex, double t) const;

  /// Cells by which a triangle may reach out of the box of its corners' grid positions.
  double margin_cells(std::size_t triangle) const { return margin_cells_[triangle]; }

  /// Triangles that may cover samples of a leaf block below this tile's parent: a seam between
  /// siblings moves, so that while it morphs a tile covers samples of its siblings.
  std::span<const std::uint32_t> triangles_over(const TileKey& leaf) const;

  /// Triangles that are not seen from above at t: turned over, on edge or without area.
  std::int64_t count_folded(double t) const;

  /// The first of them, or -1.
  std::int64_t first_folded(double t) const;

  const GridLocator& locator() const { return locator_; }

 private:
  bool is_folded(std::size_t triangle, double t) const;
  void place_vertices();
  void set_margins();
  void fill_buckets();
  template <typename Visit>
  void for_each_bucket(std::size_t triangle, Visit visit) const;

  TileMesh mesh_;
  Eigen::Vector3d step_m_;
  double reach_m_;  // how far beyond its outline it still covers samples, while it morphs
  Tiling tiling_;
  GridLocator locator_;
  bool is_flat_;  // a local frame: verticals are parallel
  std::vector<std::array<GridLocator::Located, 2>> located_;  // at t = 0 and t = 1
  std::vector<float> margin_cells_;
  TileKey region_;  // the parent, whose leaf blocks have a bucket each
  std::int64_t bucket_columns_ = 1;
  std::int64_t bucket_rows_ = 1;
  std::vector<std::uint32_t> bucket_begin_;
  std::vector<std::uint32_t> bucket_triangles_;
};

}  // namespace terrane::verify

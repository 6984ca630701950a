#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/height_source.h"
#include "tiler/pyramid.h"
#include "tiler/tile/tile_mesh.h"
#include "tiler/tileset/write_tileset.h"

namespace terrane::tiler {

/// The tiles as an implicit quadtree: which are there, and the box of each.
///
/// \par Source
/// OGC 3D Tiles 1.1, "Implicit tiling" and "Metadata".
class Subtrees {
 public:
  /// \param records  must outlive it, as must \p pyramid.
  Subtrees(const Pyramid& pyramid, const std::vector<TileRecord>& records, std::int64_t tile_cells,
           GridShape shape);

  /// The schema of the tiles' metadata.
  nlohmann::ordered_json schema() const;
  /// What makes a root tile stand for all of them.
  nlohmann::ordered_json root(double geometric_error_m) const;
  /// Every subtree with a tile in it.
  std::vector<OutputFile> files() const;

 private:
  std::vector<TileId> tiles_in_order(const TileId& subtree, int depth) const;
  std::string encode(const TileId& subtree) const;
  OrientedBox implied_box() const;

  const Pyramid& pyramid_;
  std::map<TileId, const TileRecord*> by_id_;
  std::int64_t tile_cells_;
  GridShape shape_;
  int levels_per_subtree_;
};

}  // namespace terrane::tiler

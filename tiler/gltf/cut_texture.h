#pragma once

#include <Eigen/Core>
#include <string>

#include "core/texture_source.h"
#include "tiler/tile/tile_mesh.h"

namespace terrane::tiler {

/// The picture of one tile; without bytes: none.
struct TileTexture {
  std::string bytes;
  std::string media_type;
  int columns_px = 0, rows_px = 0;
  Window window;

  bool is_there() const { return !bytes.empty(); }

  /// Texture coordinates (from the upper left) of a place in the tile: the outermost samples are in
  /// the middle of the outermost texels, so that nothing beyond them is mixed in.
  Eigen::Vector2f place_of(const Ground& ground) const;
};

/// \param source           null: no texture.
/// \param cells_per_texel  wished; wider where the picture itself has no more texels.
TileTexture cut_texture(const TextureSource* source, const Window& window, double cells_per_texel);

}  // namespace terrane::tiler

#include "tiler/gltf/cut_texture.h"

#include <algorithm>
#include <cmath>

namespace terrane::tiler {
namespace {

/// \param at  share of the way from the first sample to the last.
float coordinate(float at, int texels) {
  return (0.5F + at * static_cast<float>(texels - 1)) / static_cast<float>(texels);
}

int texels_along(std::int64_t samples, double cells_per_texel) {
  const double cells = static_cast<double>(samples - 1);
  return std::max(2, static_cast<int>(std::ceil(cells / cells_per_texel)) + 1);
}

}  // namespace

Eigen::Vector2f TileTexture::place_of(const Ground& ground) const {
  const auto share = [](float cells, std::int64_t samples) {
    return std::clamp(cells / static_cast<float>(samples - 1), 0.0F, 1.0F);
  };
  return {coordinate(share(ground.column, window.columns), columns_px),
          coordinate(share(ground.row, window.rows), rows_px)};
}

TileTexture cut_texture(const TextureSource* source, const Window& window, double cells_per_texel) {
  if (source == nullptr) return {};
  const double width = std::max(cells_per_texel, 1 / source->texels_per_cell());
  TileTexture texture{.media_type = source->media_type(),
                      .columns_px = texels_along(window.columns, width),
                      .rows_px = texels_along(window.rows, width),
                      .window = window};
  texture.bytes = source->cut(window, texture.columns_px, texture.rows_px);
  return texture;
}

}  // namespace terrane::tiler

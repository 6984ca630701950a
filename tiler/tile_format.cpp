#include "tiler/tile_format.h"

#include <fmt/format.h>

#include <cmath>

#include "core/errors.h"

namespace terrane::tiler {

std::string glb_path(const TileFormat& format, const TileId& tile, int root_level) {
  if (!format.is_implicit) return "tiles/" + path_of(tile) + ".glb";
  return fmt::format("content/{}/{}/{}.glb", root_level - tile.level, tile.x, tile.y);
}

std::string key_of(const TileFormat& format) {
  return fmt::format("{} {} {} {} {} {} {} {} {}", format.is_implicit, format.tiles_per_tileset,
                     static_cast<int>(format.compression), static_cast<int>(format.positions),
                     static_cast<int>(format.material), static_cast<int>(format.colour),
                     format.skirt_m.value_or(-1), format.texture_px, format.attribution);
}

void check(const TileFormat& format) {
  if (format.tiles_per_tileset < 1) {
    throw ConfigError(
        fmt::format("--tileset-tiles {}: must be 1 or more", format.tiles_per_tileset));
  }
  if (format.skirt_m && (!(*format.skirt_m >= 0) || !std::isfinite(*format.skirt_m))) {
    throw ConfigError(
        fmt::format("--skirts {}: must be a number of metres above 0, or auto", *format.skirt_m));
  }
  if (format.texture_px < 16 || format.texture_px > 4096) {
    throw ConfigError(fmt::format("--texture-px {}: must be from 16 to 4096", format.texture_px));
  }
}

}  // namespace terrane::tiler

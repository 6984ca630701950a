#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "archive/pmtiles_tile_id.h"

namespace terrane::archive {

/// The numbers in the name of a tile: "tiles/{level}/{x}/{y}.glb".
struct TileNumbers {
  std::uint32_t level = 0;
  std::uint32_t x = 0;
  std::uint32_t y = 0;
};

/// A file name that ends as those of tiles do.
struct TileName {
  std::string before;  ///< "tiles/", or empty
  TileNumbers numbers;
  std::string extension;  ///< ".glb"
};

/// Nothing if the name does not end with three whole numbers and an extension.
std::optional<TileName> parse_tile_name(std::string_view name);

/// The names of a quadtree's tiles and their places in PMTiles (docs/formats.md, "What terrane pack
/// writes").
class TilePath {
 public:
  TilePath(std::string before, std::string extension, int first_zoom, int zoom_step)
      : before_(std::move(before)),
        extension_(std::move(extension)),
        first_zoom_(first_zoom),
        zoom_step_(zoom_step) {}

  /// Nothing if \p pattern does not hold {l}/{x}/{y}, or the zooms are out of range.
  static std::optional<TilePath> parse(std::string_view pattern, std::int64_t first_zoom,
                                       std::int64_t zoom_step);

  std::string pattern() const { return before_ + "{l}/{x}/{y}" + extension_; }
  int first_zoom() const { return first_zoom_; }
  int zoom_step() const { return zoom_step_; }

  /// Nothing if there is no such place: a level beyond the zooms, x or y beyond the square.
  std::optional<ZoomTile> place_of(const TileNumbers& numbers) const;
  std::optional<ZoomTile> place_of(std::string_view name) const;

  /// Nothing if no level lies at the tile's zoom.
  std::optional<std::string> name_of(const ZoomTile& tile) const;

 private:
  std::string before_;
  std::string extension_;
  int first_zoom_;
  int zoom_step_;
};

}  // namespace terrane::archive

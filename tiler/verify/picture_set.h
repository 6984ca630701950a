#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/georeference.h"
#include "tiler/verify/picture_file.h"

namespace terrane::verify {

/// A tile of the web mercator pyramid: x eastward from 180 W, y southward.
struct PictureKey {
  int zoom = 0;
  std::int64_t x = 0, y = 0;

  auto operator<=>(const PictureKey&) const = default;
};
std::string to_string(const PictureKey& key);

/// What tiles.json and terrane.json say of heights as pictures.
struct PictureSet {
  std::filesystem::path folder;
  int tile_px = 0;
  std::string encoding;                   ///< as MapLibre names it: "terrarium" or "mapbox"
  std::array<double, 4> bounds_deg = {};  ///< west, south, east (beyond 180 perhaps), north
  struct Zoom {
    std::int64_t tiles = 0, bytes = 0;
  };
  std::vector<Zoom> zooms;          ///< by zoom, from 0
  std::vector<std::string> faults;  ///< a line each: where the two differ

  int finest() const { return static_cast<int>(zooms.size()) - 1; }
  double step_m() const { return encoding == "terrarium" ? 1.0 / 256 : 0.1; }
  std::filesystem::path file_of(const PictureKey& key) const;

  /// Pixels around the Earth at a zoom.
  double pixels_across(int zoom) const;
  /// Column and row in pixels of the whole map.
  std::array<double, 2> on_map(const LonLat& place, int zoom) const;

  /// Tiles of a zoom that must be there, and those that may be: what only touches them.
  std::vector<PictureKey> wanted(int zoom) const;
  bool may_have(const PictureKey& key) const;

  /// Heights of a picture in metres, row by row.
  std::vector<double> heights_of(const Picture& picture) const;
  /// What a height is stored as, in metres.
  double stored_m(double height_m) const;
};

/// \throws InputError that names the file if one is missing, damaged or of another kind.
PictureSet read_picture_set(const std::filesystem::path& folder);

}  // namespace terrane::verify

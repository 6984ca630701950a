#pragma once

#include <string_view>

namespace terrane::archive {

/// Degrees on WGS84.
struct GeographicBounds {
  double west_deg = -180;
  double south_deg = -90;
  double east_deg = 180;
  double north_deg = 90;
};

/// Where a tile set lies, for the header of an archive: a hint for maps, not exact.
///
/// \param files  JSON object of the files at the top: `bounds` of a layer.json or TileJSON, else
/// the
///               frame of a terrane.json with the root's box of a tileset.json. The whole Earth if
///               there is neither.
GeographicBounds bounds_of(std::string_view files);

}  // namespace terrane::archive

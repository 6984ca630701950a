#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/georeference.h"
#include "core/height_grid.h"
#include "core/texture_source.h"

namespace terrane::ingest {

enum class PictureFormat {
  kJpeg,  ///< quality 85
  kWebp,  ///< quality 80
};

/// Images that are laid over a DEM.
struct DrapeOptions {
  std::vector<std::string> images;  ///< a later one hides an earlier one; empty: no drape
  PictureFormat format = PictureFormat::kJpeg;
};

/// Opens images of any format and CRS to be cut over a DEM. Where they have nothing, or are
/// transparent, the picture is the grey of untextured tiles.
///
/// A texel takes the colour of the place where terrane puts its grid position on the Earth, by the
/// same operation as the terrain's own vertices.
///
/// \param place  of the DEM; must outlive the result.
/// \throws InputError if an image cannot be opened, has no place or another depth than 8 bits, or
/// if
///         none lies over the DEM.
std::unique_ptr<TextureSource> open_drape(const DrapeOptions& options, const Georeference& place,
                                          GridShape shape);

}  // namespace terrane::ingest

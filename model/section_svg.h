#pragma once

#include <string>

#include "hierarchy/volume/section.h"

namespace terrane::model {

/// What a picture of a section shows.
struct SectionPicture {
  hierarchy::volume::Plane plane;
  double upward_stretch = 1;  ///< of heights against lengths
  bool shows_mesh = true;
  /// Number of the field that gives the colours; -1: the material does.
  int field = -1;
  double lowest = 0, highest = 1;  ///< field values of the first and last colour
  int width_px = 1600;
};

/// What a material is painted with, in sRGB: "#rrggbb".
const char* material_colour(hierarchy::volume::MaterialId material);

/// Draws a cross-section as SVG: z upward, the plane's horizontal direction to the right.
/// \pre the plane is not horizontal.
std::string section_svg(const hierarchy::volume::MaterialVolume& volume,
                        const SectionPicture& picture);

}  // namespace terrane::model
